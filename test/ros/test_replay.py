# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Bags played into DDS: to a listener, and into a live node."""

import math
import os
import signal
import subprocess
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from itertools import count, pairwise
from pathlib import Path
from threading import Event
from types import SimpleNamespace

import pytest
from live import DEADLINE, Participant, rotor_bytes
from rclpy.qos import QoSProfile
from replaying import SECOND, assert_right, decode, stamp_of, valid_samples
from sensor_msgs.msg import JointState
from shipped_bags import BAGS, JOINT_STATE, OUTPUT, POSES, ROTOR, TYPES, config, write_bag

from gear_kinematics.bag import Bag, BagError, DamagedBagError
from gear_kinematics.commands.output import stopped_by_signals
from gear_kinematics.ros import live
from gear_kinematics.ros.live import ReplayError, live_messages
from gear_kinematics.ros.replay import play

pytestmark = pytest.mark.live

PERIOD = 2_000_000  # ns
COUNT = 500
DURATION = (COUNT - 1) * PERIOD / SECOND  # s
SLEW = 0.005  # s; drift between the clocks of stamps and of the player
names = (f'/played_{os.getpid()}_{number}' for number in count())


def rotor_states(times) -> list[tuple[str, int, bytes]]:
    return [
        (ROTOR, received, rotor_bytes(received - 500, position=[0.01 * number]))
        for number, received in enumerate(times)
    ]


@pytest.fixture(scope='module')
def bag_path(tmp_path_factory) -> Path:
    """Make a second of a driver's messages, and an output beside every tenth."""
    path = tmp_path_factory.mktemp('bags') / 'second'
    messages = []
    for number, message in enumerate(rotor_states(SECOND + PERIOD * k for k in range(COUNT))):
        messages.append(message)
        if number % 10 == 0:
            messages.append((OUTPUT, *message[1:]))
    return write_bag(path, messages, {ROTOR: JOINT_STATE, OUTPUT: JOINT_STATE})


@pytest.fixture(scope='module')
def recorded(bag_path) -> list[bytes]:
    with Bag(bag_path) as bag:
        return [data for _, _, data in bag.messages([ROTOR])]


class Listener(Participant):
    """Keeps the messages it receives while waiting, with their times of sending, s."""

    def __init__(self) -> None:
        super().__init__('listener')
        self.heard: dict[str, list[tuple[float, bytes]]] = {}

    def listen(self, name) -> list[tuple[float, bytes]]:
        heard = self.heard.setdefault(name, [])
        self.node.create_subscription(
            JointState,
            name,
            lambda data, about: heard.append((about['source_timestamp'] / SECOND, data)),
            QoSProfile(depth=2000),
            raw=True,
        )
        return heard


@pytest.fixture
def listener():
    listener = Listener()
    yield listener
    listener.close()


@contextmanager
def playing(path: Path, name, **options):
    """Play in a thread; gives what was played, and a function that stops it."""
    ended = Event()
    playing = SimpleNamespace(stop=ended.set)
    with Bag(path) as bag, ThreadPoolExecutor() as pool:
        played = pool.submit(play, bag, ROTOR, name, stopped=ended.is_set, **options)
        try:
            yield playing
            playing.result = played.result(DEADLINE)
        finally:
            ended.set()


def data_of(heard) -> list[bytes]:
    return [data for _, data in heard]


def stamps(heard) -> list[int]:
    return [stamp_of(decode(data, JOINT_STATE)) for data in data_of(heard)]


# A thread and a listener.


def test_a_topic_is_played_whole_in_order_and_in_time_once_there_is_a_subscriber(
    bag_path, recorded, listener
):
    name = next(names)
    with playing(bag_path, name, rate=0.5) as played:
        listener.wait_until(lambda: listener.node.count_publishers(name), 'the publisher')
        heard = listener.listen(name)
        listener.wait_until(lambda: len(heard) >= COUNT, 'every message')
    assert played.result.messages == COUNT
    assert data_of(heard) == recorded
    took = heard[-1][0] - heard[0][0]
    # On a busy machine, too, nothing is early, and delays are reported.
    assert abs(took - 2.0 * DURATION) <= played.result.worst_delay + SLEW


def test_a_loop_repeats_until_it_is_stopped(bag_path, recorded, listener):
    name = next(names)
    heard = listener.listen(name)
    # A rate at which the queue of a listener on a busy machine does not overflow.
    with playing(bag_path, name, loop=True) as played:
        listener.wait_until(lambda: len(heard) >= 2.5 * COUNT, 'the third round')
        played.stop()
    assert len(heard) <= played.result.messages
    assert data_of(heard) == (recorded * (len(heard) // COUNT + 1))[: len(heard)]
    back = [k for k, (a, b) in enumerate(pairwise(stamps(heard)), start=1) if b < a]
    assert back == list(range(COUNT, len(heard), COUNT))


@pytest.mark.parametrize('subscribed', [True, False])
def test_a_long_silence_and_the_wait_for_a_subscriber_can_be_stopped(
    tmp_path, listener, subscribed
):
    states = rotor_states([SECOND, 3600 * SECOND])
    path = write_bag(tmp_path / 'silence', states, {ROTOR: JOINT_STATE})
    name = next(names)
    heard = listener.listen(name) if subscribed else []
    with playing(path, name) as played:
        listener.wait_until(
            lambda: heard if subscribed else listener.node.count_publishers(name), 'the start'
        )
        played.stop()
    assert played.result.messages == subscribed


# Without a listener.


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_signals_stop_a_replay_and_keep_their_effect_afterwards(number):
    before = signal.getsignal(number)
    with stopped_by_signals() as stopped:
        assert not stopped()
        signal.raise_signal(number)
        assert stopped()
    assert signal.getsignal(number) == before


def test_without_a_wait_no_subscriber_is_needed(bag_path):
    seen = []
    with Bag(bag_path) as bag:
        played = play(
            bag,
            ROTOR,
            next(names),
            rate=100.0,
            wait=False,
            progress=lambda done, _: seen.append(done),
        )
    assert played.messages == COUNT
    assert (seen[0], seen[-1]) == (0, COUNT)
    assert seen == sorted(seen)


class Scripted:
    """A bag of given messages, and perhaps an exception behind them."""

    path = Path('scripted')
    type_of = Bag.type_of

    def __init__(self, messages, error=None, types=TYPES) -> None:
        self.topics = types
        self._messages = messages
        self._error = error

    def messages(self, topics):
        yield from (message for message in self._messages if message[0] in topics)
        if self._error:
            raise self._error


@pytest.mark.parametrize(
    ('topic', 'name', 'rate', 'error', 'words'),
    [
        (OUTPUT, '/x', 1.0, BagError, ['scripted', 'nothing to play', OUTPUT]),
        (POSES, '/x', 1.0, BagError, [POSES, 'PoseArray', 'JointState']),
        (ROTOR, '/x y', 1.0, ReplayError, ['/x y']),
        (ROTOR, '/x', 0.0, ValueError, ['rate']),
        (ROTOR, '/x', math.nan, ValueError, ['rate']),
    ],
)
def test_unplayable_bags_are_refused_at_once_in_one_line(topic, name, rate, error, words):
    with pytest.raises(error) as caught:
        play(Scripted([(ROTOR, SECOND, b'')]), topic, name, rate=rate)
    assert all(word in str(caught.value) for word in words)
    assert '\n' not in str(caught.value)


def test_messages_before_damage_are_played(listener):
    name = next(names)
    heard = listener.listen(name)
    messages = rotor_states([SECOND + k for k in range(5)])
    with pytest.raises(DamagedBagError, match='torn'):
        play(Scripted(messages, DamagedBagError('torn')), ROTOR, name)
    listener.wait_until(lambda: len(heard) == 5, 'every message')


# Into a live node.


def by_topic(messages) -> dict[str, list[bytes]]:
    found = {topic: [] for topic in TYPES}
    for topic, _, data in messages:
        found[topic].append(data)
    return found


@pytest.mark.parametrize(
    ('name', 'settings', 'rate'),
    [('driver_faults', 'actuator', 1.0), ('single_turn_encoder', 'single_turn', 1000.0)],
)
def test_a_live_node_publishes_what_it_published_when_recorded(name, settings, rate):
    seen = []
    with Bag(BAGS / name) as bag:
        recorded = by_topic(bag.messages(TYPES))
        published = list(
            live_messages(
                bag, config(settings), rate=rate, progress=lambda done, _: seen.append(done)
            )
        )
    assert by_topic(published) == recorded
    times = [received for _, received, _ in published]
    assert times == sorted(times)
    assert seen[-1] == len(recorded[ROTOR])


@pytest.mark.slow
@pytest.mark.parametrize(
    ('pattern', 'topic', 'joint', 'count'),
    [
        ('feetech_servos', '/servo/out/state', 'q0', 954),
        ('pr2_joints/*.bag', '/joint_states', 'laser_tilt_mount_joint', 1325),  # of ROS 1
    ],
)
def test_a_live_node_publishes_what_a_real_recording_calls_for(
    shared_path, pattern, topic, joint, count
):
    [path] = shared_path('data/bags').glob(pattern)
    settings = config(rotor_joint=joint)
    with Bag(path) as bag:
        found = by_topic(live_messages(bag, settings, rotor_topic=topic, rate=1000.0))
    samples, rejected = valid_samples(found[ROTOR], joint=joint)
    assert (len(samples), rejected) == (count, {})
    assert_right(samples, found[OUTPUT], found[POSES])


def test_live_messages_with_another_topic_joint_and_prefix_add_missing_stamps(tmp_path):
    times = [SECOND + k for k in range(20)]
    little, big = (rotor_bytes(0, ['m1'], [1.0], little_endian=order) for order in (True, False))
    messages = [('/m', time, big if time % 2 else little) for time in times]
    source = Scripted(messages, types={'/m': JOINT_STATE})
    (tmp_path / 'home.yaml').touch()  # which the node of the replay has to leave alone
    settings = config(rotor_joint='', frame_prefix='left_', home_file=str(tmp_path / 'home.yaml'))
    found = by_topic(live_messages(source, settings, rotor_topic='/m'))
    for topic in (ROTOR, OUTPUT):
        assert stamps([(0.0, data) for data in found[topic]]) == times
    assert [decode(d, JOINT_STATE).name for d in found[OUTPUT]] == [['left_output_shaft']] * 20
    assert [decode(d, TYPES[POSES]).header.frame_id for d in found[POSES]] == ['left_stator'] * 20


def test_missing_stamp_is_added_in_the_byte_order_of_xcdr_2_too():
    big = b'\0\6\0\0' + rotor_bytes(0, little_endian=False)[4:]
    expected = rotor_bytes(5 * SECOND + 7, little_endian=False)
    assert live._stamped(big, 5 * SECOND + 7)[4:] == expected[4:]


def test_a_slow_consumer_loses_nothing_of_the_part_before_damage():
    messages = rotor_states(SECOND + k for k in range(6000))
    found = Counter()

    def consume():
        for number, message in enumerate(live_messages(source, config())):
            found[message[0]] += 1
            if number == 9000:
                time.sleep(1.2)  # the node goes on meanwhile

    source = Scripted(messages, DamagedBagError('torn'))
    with pytest.raises(DamagedBagError, match='torn'):
        consume()
    assert found == dict.fromkeys(TYPES, 6000)


@pytest.fixture
def processes(monkeypatch) -> list[subprocess.Popen]:
    """The node processes that are started."""
    started = []

    class Noted(subprocess.Popen):
        def __init__(self, *arguments, **options) -> None:
            super().__init__(*arguments, **options)
            started.append(self)

    monkeypatch.setattr(live.subprocess, 'Popen', Noted)
    return started


def test_the_node_ends_with_its_consumer(processes):
    messages = live_messages(Scripted(rotor_states([SECOND, 3600 * SECOND])), config())
    assert next(messages)[0] == ROTOR
    messages.close()
    [process] = processes
    assert process.returncode == 0


def test_a_node_that_ends_is_an_error(processes):
    messages = live_messages(Scripted(rotor_states(SECOND + k for k in range(5000))), config())
    next(messages)
    # If killed, it may leave a lock in shared memory, which would block Fast DDS here.
    processes[0].terminate()
    with pytest.raises(ReplayError, match='has ended'):
        list(messages)


def test_a_node_that_does_not_start_gives_the_cause():
    with pytest.raises(ReplayError, match=r'has ended.*ring_teeth'):
        next(live_messages(Scripted(rotor_states([SECOND])), config(ring_teeth=10**6)))


def test_live_messages_name_an_unusable_topic():
    with pytest.raises(BagError, match=f'{POSES} is of type .*PoseArray, not .*JointState'):
        next(live_messages(Scripted([]), config(), rotor_topic=POSES))


def test_environment_is_as_before_after_a_validation_of_a_live_node(monkeypatch):
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'SUBNET')
    monkeypatch.delenv('SKIP_DEFAULT_XML_FILE', raising=False)
    seen, before = [], dict(os.environ)

    @contextmanager
    def refused(_arguments, **options):
        seen.append(options['env'])
        raise ReplayError('no')
        yield

    monkeypatch.setattr(live, 'running_node', refused)
    with pytest.raises(ReplayError, match='no'), live._private_node(config()):
        pass
    assert seen[0]['ROS_AUTOMATIC_DISCOVERY_RANGE'] == 'LOCALHOST'
    assert seen[0]['SKIP_DEFAULT_XML_FILE'] == '1'
    assert dict(os.environ) == before


def test_node_that_does_not_end_is_killed(monkeypatch, tmp_path):
    program = tmp_path / 'python'  # in place of the interpreter: it ignores SIGTERM
    program.write_text("#!/bin/sh\ntrap '' TERM\necho ready\nexec sleep 600\n")
    program.chmod(0o755)
    monkeypatch.setattr('sys.executable', str(program))
    monkeypatch.setattr(live, '_STOP_TIMEOUT', 0.2)
    with live.running_node(stdout=subprocess.PIPE) as process, process.stdout as told:
        assert told.readline() == 'ready\n'
    assert process.returncode == -signal.SIGKILL

"""What a bench does to a running node: it answers nothing wrong, and loses nothing on its own."""

import math
import multiprocessing
import operator
import os
import re
import signal
import subprocess
import sys
import time
from bisect import bisect_right
from collections import Counter, defaultdict, deque
from contextlib import ExitStack, closing, contextmanager, suppress
from functools import cache
from itertools import count, cycle, islice, pairwise
from pathlib import Path
from random import Random
from typing import NamedTuple

import oracle
import pytest
from blocked_bags import GEARKIN
from driver import MILLISECOND, drive, rotor_position
from geometry_msgs.msg import PoseArray
from live import (
    LATCHED,
    PATIENT,
    SECOND,
    START,
    STATES,
    Listener,
    Peer,
    connected,
    live_node,
    rotor_bytes,
    rotor_state,
    stamp_of,
)
from rclpy.duration import Duration
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.serialization import serialize_message
from replaying import ACTUATOR, BOUND, valid_samples
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from gear_kinematics.bag import BagWriter
from gear_kinematics.ros.live import running_node

pytestmark = pytest.mark.live

OK, WARN, ERROR = 0, 1, 2
BEST_EFFORT = QoSProfile(depth=2000, reliability=ReliabilityPolicy.BEST_EFFORT)
PATIENCE = 20.0  # s: far beyond anything but a loss
UNIT = ACTUATOR.eccentricity
names = (f'/faults_{os.getpid()}_{number}' for number in count())

# Drivers that start in no time, and free of this process's threads.
forks = multiprocessing.get_context('forkserver')
forks.set_forkserver_preload(['rclpy.node', 'sensor_msgs.msg'])


# What is right.


class Settings(NamedTuple):
    """The parameters that shape the outputs, by their names."""

    rotor_direction: int = 1
    rotor_zero: float = 0.0
    output_joint: str = 'output_shaft'
    frame_prefix: str = ''


DEFAULT = Settings()
NO_CHANGES: dict[int, Settings] = {}
NONE = {'lost': 0, 'wrong': 0}


class Contents(NamedTuple):
    """What a message says: names, angles in rad, lengths in units of the eccentricity."""

    names: list[str]
    numbers: list[float]


def contents(message) -> Contents:
    if isinstance(message, PoseArray):
        numbers = []
        for pose in message.poses:
            p, q = pose.position, pose.orientation
            numbers += [p.x / UNIT, p.y / UNIT, p.z / UNIT, q.x, q.y, q.z, q.w]
        return Contents([message.header.frame_id], numbers)
    found = joints(
        (name, position / (UNIT if 'oldham' in name else 1.0))
        for name, position in zip(message.name, message.position, strict=True)
    )
    found.numbers.extend([*message.velocity, *message.effort])
    return found


def joints(positions) -> Contents:
    """Give joints in the order of their names."""
    found = sorted(positions)
    return Contents([name for name, _ in found], [float(position) for _, position in found])


@cache
def motion(position, zero, direction):
    rotor_angle = oracle.rotor_angle_of(position, zero, direction)
    return rotor_angle, oracle.expected_motion(ACTUATOR, rotor_angle)


@cache
def expected(position, settings) -> dict[str, Contents]:
    """Work the three outputs out, at 50 digits."""
    rotor, moved = motion(position, settings.rotor_zero, settings.rotor_direction)
    shaft, branches = moved.output_angle, moved.branches
    prefix, joint = settings.frame_prefix, settings.frame_prefix + settings.output_joint
    positions = [(prefix + 'rotor', rotor), (joint, shaft)]
    for name, branch in zip('ab', branches, strict=True):
        positions.append((f'{prefix}satellite_{name}', shaft - rotor))
        positions.append((f'{prefix}oldham_{name}', branch.satellite_slide / UNIT))
    cosine, sine = oracle.mp.cos_sin(shaft / 2)
    quaternion = (0, 0, sine, cosine) if cosine > 0 else (0, 0, -sine, -cosine)
    centres = [branch.satellite_centre for branch in branches]
    centres += [branch.oldham_centre for branch in branches]
    numbers = [
        float(number)
        for centre in centres
        for number in (*(length / UNIT for length in centre), *quaternion)
    ]
    outputs = joints([(joint, shaft)]), Contents([f'{prefix}stator'], numbers), joints(positions)
    return dict(zip(STATES, outputs, strict=True))


def is_right(name, message, settings=DEFAULT) -> bool:
    """Hold an output against what the rotor's position at its stamp calls for."""
    names, numbers = contents(message)
    wanted = expected(rotor_position(stamp_of(message)), settings)[name]
    return (names, len(numbers)) == (wanted.names, len(wanted.numbers)) and all(
        abs(a - b) <= BOUND for a, b in zip(numbers, wanted.numbers, strict=True)
    )


class Tally:
    """The count of lost and wrong outputs."""

    def __init__(self) -> None:
        """Begin with none."""
        self.lost = self.wrong = 0

    def count(self, received, sent, *, joined_late=False, settings=NO_CHANGES) -> None:
        """Count outputs by topic against the stamps, in order, of what they should answer.

        Who has joined late is owed everything from its first output on. Settings are by stamp,
        where they are not the default ones.
        """
        for name, messages in received.items():
            if name not in STATES:
                continue
            owed = sent
            if joined_late and messages:
                owed = sent[sent.index(stamp_of(messages[0])) :]
            stamps = [stamp_of(message) for message in messages]
            self.lost += (Counter(owed) - Counter(stamps)).total()
            to_come = iter(owed)
            self.wrong += sum(
                stamp not in to_come or not is_right(name, message, settings.get(stamp, DEFAULT))
                for stamp, message in zip(stamps, messages, strict=True)
            )

    @property
    def faults(self) -> dict[str, int]:
        """Both counts by their names."""
        return {'lost': self.lost, 'wrong': self.wrong}


@pytest.fixture
def tally(record_property):
    """Return a tally, which is recorded in the end."""
    tally = Tally()
    yield tally
    for fault, number in tally.faults.items():
        record_property(fault, number)
    print(tally.faults)


# Driving and listening.


def seeded() -> Random:
    return Random(6)  # noqa: S311, no secret


def message_at(stamp):
    return rotor_state(stamp, position=[rotor_position(stamp)])


class Drive:
    """A driver on a peer, which sends within the waits of the peer."""

    def __init__(self, peer, *, rate=1000.0, ahead=500, publish=None) -> None:
        """Start at a rate in Hz, never further ahead of the outputs than so many messages."""
        self.sent: list[int] = []
        self._peer = peer
        self._publish = publish or peer.send
        self._ahead = ahead
        self._answered = min(map(len, self._outputs()))
        self.timer = peer.node.create_timer(1.0 / rate, self._send)

    def finish(self) -> list[int]:
        """Stop, wait for what is still to come, and give the stamps of what was sent."""
        self.timer.cancel()
        until = time.monotonic() + PATIENCE
        self._peer.wait_until(
            lambda: self._is_answered() or time.monotonic() > until, 'the last outputs'
        )
        return self.sent

    def _send(self) -> None:
        answered = min(map(len, self._outputs())) - self._answered
        if len(self.sent) - answered < self._ahead:
            self.sent.append(self._peer.stamp())
            self._publish(message_at(self.sent[-1]))

    def _is_answered(self) -> bool:
        return all(
            outputs and stamp_of(outputs[-1]) == self.sent[-1] for outputs in self._outputs()
        )

    def _outputs(self):
        return [self._peer.received[name] for name in STATES]


def another_driver(peer, depth):
    """Give another driver, which the node hears, with a history of so many messages."""
    driver = peer.node.create_publisher(JointState, 'rotor_state', QoSProfile(depth=depth))
    peer.wait_until(driver.get_subscription_count, 'the node to hear the driver')
    return driver


def parameter(name, value) -> tuple[str, str]:
    return '-p', f'{name}:={value}'


def heard(listener) -> int:
    """Count the outputs that have come on every topic."""
    return min(len(listener.received[name]) for name in STATES)


def newest(listener) -> int:
    """Give the newest stamp that has come on every topic; 0 if there is none."""
    outputs = [listener.received[name] for name in STATES]
    return min(stamp_of(messages[-1]) if messages else 0 for messages in outputs)


# Processes that die.


@contextmanager
def swept(pid):
    """Take away the shared memory that a process leaves, which is killed within."""
    held = []
    for file in Path(f'/proc/{pid}/fd').iterdir():
        with suppress(FileNotFoundError):  # closed meanwhile
            held.append(file.readlink())
    yield
    for lock in held:
        if re.fullmatch('fastrtps_[0-9a-f]{16}_el', lock.name):  # of its own memory
            Path(str(lock).removesuffix('_el')).unlink(missing_ok=True)
            lock.unlink(missing_ok=True)


class KillableDriver:
    """A driver process that is ready to go, and then publishes until it is killed."""

    def __init__(self, peer, start) -> None:
        """Start the process; the stamps of its messages are from `start` on, ns."""
        self._go, self._acknowledged = forks.Event(), forks.RawValue('q')
        arguments = f'{peer.namespace}/rotor_state', start, self._go, self._acknowledged
        self._process = forks.Process(target=drive, args=arguments, daemon=True)
        self._process.start()
        self.go = self._go.set

    def kill(self) -> int:
        """Kill it, and give the last stamp of which it knows that it has arrived."""
        if self._process.is_alive():
            with swept(self._process.pid):
                self._process.kill()
                self._process.join()
        return self._acknowledged.value


def test_driver_killed_and_restarted_twenty_times(tmp_path, tally):
    with connected(tmp_path) as peer, ExitStack() as stack:
        arrived = {}
        # The middleware takes seconds to connect a new driver: five at a time.
        for first in range(START, 21 * START, 5 * START):
            starts = range(first, first + 5 * START, START)
            drivers = {start: KillableDriver(peer, start) for start in starts}
            for driver in drivers.values():
                stack.callback(driver.kill)
            for start, driver in drivers.items():
                driver.go()
                peer.wait_until(lambda s=start: newest(peer) >= s + 50 * MILLISECOND, 'outputs')
                arrived[start] = driver.kill()
                peer.wait_until(lambda s=start: newest(peer) >= arrived[s], 'what has arrived')
        peer.status()  # whatever else comes meanwhile is wrong
        sent = []
        for start, last in arrived.items():
            # What the node took, but had not acknowledged yet, is answered as well.
            stamps = (stamp_of(message) for name in STATES for message in peer.received[name])
            taken = (stamp for stamp in stamps if start <= stamp < start + START)
            sent += range(start, max(last, *taken) + 1, MILLISECOND)
        tally.count(peer.received, sent)
    assert tally.faults == NONE


@pytest.mark.parametrize(('encoder', 'referenced'), [('multi_turn', True), ('single_turn', False)])
def test_node_killed_and_restarted_while_the_driver_runs(tmp_path, tally, encoder, referenced):
    namespace = next(names)
    command = ['--ros-args', '-r', f'__ns:={namespace}', *PATIENT]
    command += parameter('rotor_encoder', encoder)
    environment = os.environ | {'ROS_LOG_DIR': str(tmp_path)}
    with closing(Peer(namespace)) as peer:
        home = peer.node.create_client(Trigger, 'gear_state_publisher/home')

        def reference():
            # For a while the middleware takes the killed node's service for ready as well.
            peer.status(
                lambda status: 'not referenced' not in status.message,
                'a reference',
                lambda: home.call_async(Trigger.Request()),
            )

        with running_node(command, env=environment) as process:
            peer.connect()
            # With a full history, what is missing is made up for at once and not every 3 s.
            driver = another_driver(peer, depth=100)
            drive = Drive(peer, rate=200.0, ahead=math.inf, publish=driver.publish)
            peer.wait_until(lambda: heard(peer) > 100, 'outputs')
            reference()
            matches = peer.matches()
            with swept(process.pid):
                process.kill()
                process.wait()
        # Another participant takes the ports of the killed node: who gets them is found late.
        with closing(Listener(next(names))), running_node(command, env=environment) as process:
            peer.wait_until(
                lambda: all(map(operator.gt, peer.matches(), matches)), 'the node to be found'
            )
            found, last = time.monotonic(), drive.sent[-1]
            peer.wait_until(lambda: newest(peer) > last, 'outputs')
            assert time.monotonic() - found < 1.0
            level, message, values = peer.status()
            sent = drive.finish()
            received = {
                name: [message for message in peer.received[name] if stamp_of(message) > last]
                for name in STATES
            }
            tally.count(received, sent, joined_late=True)
            drive.timer.reset()
            reference()
    assert process.returncode == 0
    assert values['referenced'] == str(referenced).lower()
    assert ('not referenced' in message, level == ERROR) == (not referenced,) * 2
    assert values['lost messages'] == '0'
    assert tally.faults == NONE


# Clocks that step, and bags that loop.


def test_stamps_that_step(tmp_path, tally):
    random, stamp, stamps = seeded(), 10_000 * START, []
    hour = 3600 * SECOND
    steps = [hour, -hour, SECOND, -SECOND, -SECOND - 1, -SECOND // 4, -MILLISECOND, 0]
    for _ in range(30):
        stamp += random.choice(steps)
        stamps += range(stamp, stamp + 20 * MILLISECOND, MILLISECOND)
        stamp = stamps[-1]
    stamps.append(stamp + 2 * hour)
    samples, rejected = valid_samples(
        [rotor_bytes(stamp, position=[rotor_position(stamp)]) for stamp in stamps]
    )
    sent = [sample.stamp for sample in samples]
    with connected(tmp_path) as peer:
        peer.send(*map(message_at, stamps))
        peer.wait_until(lambda: newest(peer) == stamps[-1], 'the last output')
        _, _, values = peer.status()
        tally.count(peer.received, sent)
    assert tally.faults == NONE
    assert values['rejected: out of order'] == str(rejected['out of order'])
    assert values['clock resets'] == str(sum(b < a for a, b in pairwise(sent)))


def test_clock_that_steps(tmp_path, tally):
    with connected(tmp_path, *parameter('use_sim_time', value='true')) as peer:
        clock = peer.node.create_publisher(Clock, '/clock', QoSProfile(depth=1))
        sent = []
        for seconds in (4000.0, 3999.5, 100.0, 4000.0):
            now, stamp = Clock(), round(seconds * SECOND)
            now.clock.sec, now.clock.nanosec = divmod(stamp, SECOND)

            def publish(now=now):
                clock.publish(now)

            while stamp_of(peer.report(meanwhile=publish)[0]) != stamp:
                pass
            peer.send(*[rotor_state(0, position=[rotor_position(stamp)])] * 20)
            if seconds == 3999.5:  # too little for a new beginning
                peer.status(lambda status: rejected_in(status) == '20', '20 messages out of order')
            else:
                sent += [stamp] * 20
                wanted = len(sent)
                peer.wait_until(lambda n=wanted: heard(peer) == n, 'outputs')
        _, _, values = peer.status()
        tally.count(peer.received, sent)
    assert tally.faults == NONE
    assert (values['clock resets'], values['rejected: out of order']) == ('1', '20')


def test_bag_that_loops(tmp_path, tally):
    stamps = range(START, START + 3 * SECOND // 2, 15 * MILLISECOND)
    with connected(tmp_path) as peer:
        topic = f'{peer.namespace}/rotor_state'
        with BagWriter(tmp_path / 'bag') as writer:
            writer.add_topic(topic, 'sensor_msgs/msg/JointState')
            for stamp in stamps:
                writer.write(topic, stamp, rotor_bytes(stamp, position=[rotor_position(stamp)]))
        command = [sys.executable, '-c', GEARKIN, 'replay', str(tmp_path / 'bag'),
                   '--loop', '--rate', '4', '--topics', topic]  # fmt: skip
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as replay:
            peer.wait_until(lambda: heard(peer) > 3.5 * len(stamps), 'the fourth round')
            replay.send_signal(signal.SIGINT)
            said, _ = replay.communicate(timeout=PATIENCE)
        sent = list(islice(cycle(stamps), int(said.split()[0])))
        peer.wait_until(lambda: heard(peer) >= len(sent), 'every output')
        _, _, values = peer.status()
        tally.count(peer.received, sent)
    assert replay.returncode == 130
    assert tally.faults == NONE
    assert values['clock resets'] == str(sum(b < a for a, b in pairwise(sent)))


# Quality of service that does not match.


def qos_override(topic, end, reliability) -> tuple[str, str]:
    return parameter(f'qos_overrides.{topic}.{end}.reliability', reliability)


def test_best_effort_driver_is_not_taken_where_reliable_is_asked_for(tmp_path, tally):
    namespace = next(names)
    override = qos_override(f'{namespace}/rotor_state', 'subscription', 'reliable')
    with connected(tmp_path, *override, namespace=namespace) as peer:
        stranger = peer.node.create_publisher(JointState, 'rotor_state', BEST_EFFORT)
        drive = Drive(peer)
        fault = f'incompatible QoS on rotor_state: RELIABILITY (driver {namespace}/peer)'
        level, _, _ = peer.status(
            lambda status: fault in status.message,
            'an error',
            lambda: stranger.publish(message_at(peer.stamp())),
        )
        tally.count(peer.received, drive.finish())
    assert level == ERROR
    assert tally.faults == NONE


def test_listeners_that_want_old_outputs_do_not_disturb_the_others(tmp_path, tally):
    with connected(tmp_path) as peer:
        drive = Drive(peer)
        for name, message_type in zip(STATES, (JointState, PoseArray, JointState), strict=True):
            peer.listen(message_type, f'old {name}', LATCHED, name)
        faults = [
            f'incompatible QoS on {name}: DURABILITY (listener {peer.namespace}/peer)'
            for name in STATES
        ]
        level, _, _ = peer.status(
            lambda status: status.message.split('; ') == faults, 'a warning of every topic'
        )
        tally.count(peer.received, drive.finish())
    assert level == WARN
    assert tally.faults == NONE
    assert not any(peer.received[f'old {name}'] for name in STATES)


def test_reliable_listener_to_a_best_effort_topic_does_not_disturb_the_others(tmp_path, tally):
    namespace = next(names)
    override = qos_override(f'{namespace}/body_poses', 'publisher', 'best_effort')
    with live_node(tmp_path, *PATIENT, *override, namespace=namespace) as live:
        peer = live.peer  # which listens reliably to all
        peer.listen(PoseArray, 'body_poses', BEST_EFFORT)
        peer.connect()
        drive = Drive(peer)
        fault = f'incompatible QoS on body_poses: RELIABILITY (listener {namespace}/peer)'
        level, _, _ = peer.status(lambda status: status.message == fault, 'a warning')
        sent = drive.finish()
        poses = peer.received.pop('body_poses')
        tally.count(peer.received, sent)
        tally.count(
            {'body_poses': poses}, [stamp for stamp in sent if stamp in set(map(stamp_of, poses))]
        )
    assert level == WARN
    assert tally.faults == NONE


# Many at once.


def test_twenty_subscribers_come_and_go(tmp_path, tally, record_property):
    with connected(tmp_path) as peer:
        drive, began = Drive(peer), time.monotonic()
        to_come = (Listener(peer.namespace, f'listener_{number}') for number in range(20))
        present = deque(islice(to_come, 5))

        def leave(listener):
            # Nothing is sent meanwhile, and what was sent has to come.
            listener.wait_until(lambda: newest(listener) == drive.sent[-1], 'the last output')
            listener.close()
            tally.count(listener.received, drive.sent, joined_late=True)

        def another_is_served():
            listener = present[0]
            present.rotate()
            listener.receive()
            if heard(listener) < 10:
                return False
            present.remove(listener)
            leave(listener)
            present.extend(islice(to_come, 1))
            return True

        for number in range(20):
            peer.wait_until(another_is_served, f'the outputs for listener {number}')
        record_property('rate', len(drive.sent) / (time.monotonic() - began))
        tally.count(peer.received, drive.finish())
    assert tally.faults == NONE


def test_two_drivers_are_reported_and_answered(tmp_path, tally):
    with connected(tmp_path, *PATIENT) as peer:
        second = another_driver(peer, depth=2000)
        sent = []
        # In turns, each after the answer to the other.
        for publish in (peer.send, second.publish) * 50:
            sent.append(peer.stamp())
            publish(message_at(sent[-1]))
            peer.wait_until(lambda: newest(peer) == sent[-1], 'an answer')
        # At once, and nothing of the second is in order.
        drive = Drive(peer)
        for number in range(40):
            second.publish(message_at(sent[-1] - (40 - number) * MILLISECOND))
        level, message, values = peer.status(
            lambda status: rejected_in(status) == '40', '40 messages out of order'
        )
        peer.node.destroy_publisher(second)
        peer.status(lambda status: status.message == 'ok', 'the report of a single driver')
        tally.count(peer.received, sent + drive.finish())
    assert (level, '2 drivers' in message, values['drivers']) == (WARN, True, '2')
    assert tally.faults == NONE


def test_overrun_by_a_driver_of_short_memory_does_not_stop_the_node(tmp_path, tally):
    with connected(tmp_path, *PATIENT) as peer:
        hasty = another_driver(peer, depth=10)
        sent = []
        for _ in range(10):
            burst = [peer.stamp()] * 20_000
            message = serialize_message(message_at(burst[0]))
            for _ in burst:
                hasty.publish(message)
            sent += burst
            peer.status()
        peer.wait_until(lambda: newest(peer) == sent[-1], 'an output of the last burst')
        _, _, values = peer.status()
        tally.count(peer.received, sent)
    assert tally.wrong == 0
    assert 0 < int(values['lost messages']) < len(sent)


def rejected_in(status) -> str | None:
    values = {pair.key: pair.value for pair in status.values}
    return values.get('rejected: out of order')


# Parameters.

CHOICES = {
    'rotor_direction': (1, -1),
    'rotor_zero': (0.0, 1.25, -0.5),
    'output_joint': ('output_shaft', 'shoulder'),
    'frame_prefix': ('', 'left_'),
}
REFUSED = (
    ('rotor_direction', 0),
    ('rotor_direction', -1.0),
    ('rotor_zero', math.nan),
    ('rotor_zero', 'far'),
    ('output_joint', 'satellite_a'),
    ('frame_prefix', 3),
    ('rotor_encoder', 'absolute'),
    ('ring_teeth', 81),
    ('no_such_parameter', 1.0),
)


def test_parameters_set_at_random_take_effect_between_two_messages(tmp_path, tally):
    random = seeded()
    states, acknowledged = [DEFAULT], [0]
    with connected(tmp_path) as peer:
        drive = Drive(peer, rate=500.0)
        start = time.monotonic()
        for turn in range(150):
            peer.wait_until(lambda t=turn: time.monotonic() >= start + t / 50.0, 'the next turn')
            chosen = random.sample(list(CHOICES), random.randint(1, len(CHOICES)))
            changes = {name: random.choice(CHOICES[name]) for name in chosen}
            values = list(changes.items())
            if bad := random.random() < 0.4:
                values.insert(random.randint(0, len(values)), random.choice(REFUSED))
            result = peer.set_atomically([Parameter(name, value=value) for name, value in values])
            assert result.successful == (not bad), result.reason
            if not bad:
                states.append(states[-1]._replace(**changes))
                acknowledged.append(len(drive.sent))
        sent = drive.finish()
        assert peer.get(*Settings._fields) == list(states[-1])
        outputs = outputs_by_stamp(peer)
    # The earliest state that fits, not before that of the last message nor the last set that was
    # acknowledged before the message was sent.
    seen, now = {}, 0
    for number, stamp in enumerate(sent):
        later = range(max(now, bisect_right(acknowledged, number) - 1), len(states))
        now = next((k for k in later if fits(outputs[stamp], states[k])), later.start)
        seen[stamp] = states[now]
    tally.count(peer.received, sent, settings=seen)
    assert tally.faults == NONE
    assert len(set(seen.values())) > 12  # of the 24 that there are


def outputs_by_stamp(peer) -> dict[int, dict]:
    found = defaultdict(dict)
    for name in STATES:
        for message in peer.received[name]:
            found[stamp_of(message)][name] = message
    return found


def fits(outputs, settings) -> bool:
    return all(is_right(name, message, settings) for name, message in outputs.items())


# The end.


def test_what_was_received_before_the_signal_is_answered(tmp_path, tally):
    with live_node(tmp_path) as live:
        peer = live.peer
        peer.connect()
        # With a full history, acknowledgement is asked for at once.
        burst = 100
        driver = another_driver(peer, depth=burst)
        sent = []

        def send_burst():
            for _ in range(burst):
                sent.append(peer.stamp())
                driver.publish(message_at(sent[-1]))

        send_burst()
        peer.wait_until(lambda: newest(peer) == sent[-1], 'answers')
        for _ in range(2):
            send_burst()
            assert driver.wait_for_all_acked(Duration(seconds=10))
        received = len(sent)
        live.process.send_signal(signal.SIGTERM)
        while live.process.poll() is None and len(sent) < 1500:
            sent.append(peer.stamp())
            peer.send(message_at(sent[-1]))
        assert live.process.wait(PATIENCE) == 0
        peer.alive = lambda: True
        until = time.monotonic() + PATIENCE
        peer.wait_until(lambda: heard(peer) >= received or time.monotonic() > until, 'the last')
        # Whatever else the node has sent is here already.
        before, taken = -1, 0
        while taken > before:
            before = taken
            for _ in range(20):
                peer.receive()
            taken = max(len(peer.received[name]) for name in STATES)
        tally.count(peer.received, sent[: max(taken, received)])
    assert tally.faults == NONE

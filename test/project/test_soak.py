"""The soak: twenty seconds of it, and that it finds what it looks for."""

import json
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import oracle
import pytest
import soak
from geometry_msgs.msg import Pose, PoseArray
from live import SECOND
from rclpy.serialization import serialize_message
from rotor_driver import counted_stamp, rotor_motion
from sensor_msgs.msg import JointState

BENCHMARK = Path(__file__).resolve().parents[2] / 'benchmark'
NUMBERS = oracle.Numbers(80, 76, 0.0011, ((0.0, 0.04), (math.pi, -0.04)))
RATIO = -19
SENT = 4  # messages
TOPICS = ('output_state', 'body_poses', 'mechanism_joint_states')


@pytest.mark.live
@pytest.mark.slow
def test_twenty_seconds_lose_nothing_and_keep_their_memory():
    # Measuring the node's coverage would slow it down.
    environment = {k: v for k, v in os.environ.items() if not k.startswith('COVERAGE_')}
    done = subprocess.run(
        [sys.executable, str(BENCHMARK / 'soak.py'), '--minutes', str(20 / 60), '--json'],
        check=False, capture_output=True, text=True, timeout=240.0, env=environment,
    )  # fmt: skip
    assert done.stdout, done.stderr
    result = json.loads(done.stdout)
    assert result['sent'] == 20_000
    assert result['lost'] == result['wrong'] == dict.fromkeys(TOPICS, 0)
    assert result['flat'], result['memory']
    assert done.returncode == 0


# That it finds what it looks for.


def answer(topic, number):
    """Make the message that has to come, at 50 digits."""
    position, velocity, effort = rotor_motion(number)
    exact = oracle.rotor_angle_of(position)
    value, rate, _ = oracle.expected_derivatives(NUMBERS, exact, velocity, 0.0)
    if topic == 'output_state':
        message = JointState(
            name=['output_shaft'],
            position=[float(value.output_angle)],
            velocity=[float(rate.output_angle)],
            effort=[RATIO * effort],
        )
    elif topic == 'body_poses':
        message = PoseArray()
        message.header.frame_id = 'stator'
        turns = oracle.mp.nint(value.output_angle / (2 * oracle.mp.pi))
        half = value.output_angle / 2 - turns * oracle.mp.pi
        for centre in ('satellite_centre', 'oldham_centre'):
            for branch in value.branches:
                pose = Pose()
                point, orientation = pose.position, pose.orientation
                point.x, point.y, point.z = map(float, getattr(branch, centre))
                orientation.w, orientation.z = map(float, oracle.mp.cos_sin(half))
                message.poses.append(pose)
    else:
        message = JointState(
            name=['rotor', 'satellite_a', 'satellite_b', 'oldham_a', 'oldham_b', 'output_shaft'],
            position=joint_values(value, exact),
            velocity=joint_values(rate, velocity),
        )
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(counted_stamp(number), SECOND)
    return message


def joint_values(motion, rotor) -> list[float]:
    on_cam = [motion.output_angle - rotor] * 2
    slides = [branch.satellite_slide for branch in motion.branches]
    return [float(number) for number in (rotor, *on_cam, *slides, motion.output_angle)]


def nudge(message):
    """Put a position off by twice what is allowed."""
    if isinstance(message, PoseArray):
        message.poses[-1].position.y += 2e-12 * NUMBERS.eccentricity
    else:
        message.position[-1] += 2e-12


def tilt(message):
    if isinstance(message, PoseArray):
        message.poses[0].orientation.x = 2e-12
    else:
        message.velocity[0] += 2e-9


def date(message):
    message.header.stamp.nanosec += 1


def rename(message):
    if isinstance(message, PoseArray):
        message.header.frame_id = 'rotor'
    else:
        message.name[0] = 'joint'


def empty(message):
    if isinstance(message, PoseArray):
        message.poses.pop()
    else:
        message.velocity = []


def compare(mechanism, topic, messages) -> tuple[int, int]:
    """Give the numbers of lost and of wrong messages."""
    checked = soak.Topic(soak.TOPICS[topic](mechanism))
    for message in messages:
        checked.add(message)
    checked.close(SENT)
    assert len(checked) == len(messages)
    return checked.lost, checked.wrong


@pytest.mark.parametrize('topic', TOPICS)
@pytest.mark.parametrize(
    ('order', 'lost', 'wrong'),
    [
        ([0, 1, 2, 3], 0, 0),
        ([0, 2, 3], 1, 0),
        ([0, 1, 2], 1, 0),
        ([], 4, 0),
        ([0, 1, 1, 2, 3], 0, 1),
        ([0, 2, 1, 3], 1, 1),
    ],
    ids=str,
)
def test_messages_that_are_missing_or_in_disorder_are_counted(actuator, topic, order, lost, wrong):
    messages = [serialize_message(answer(topic, number)) for number in order]
    assert compare(actuator, topic, messages) == (lost, wrong)


@pytest.mark.parametrize('topic', TOPICS)
@pytest.mark.parametrize('damage', [nudge, tilt, date, rename, empty])
def test_message_with_a_wrong_number_stamp_or_name_is_found(actuator, topic, damage):
    messages = [answer(topic, number) for number in range(SENT)]
    damage(messages[1])
    assert compare(actuator, topic, [*map(serialize_message, messages)]) == (1, 1)


@pytest.mark.parametrize('topic', TOPICS)
def test_bytes_that_are_no_message_are_found(actuator, topic):
    messages = [serialize_message(answer(topic, number)) for number in range(SENT)]
    messages[2] = messages[2][:40]
    assert compare(actuator, topic, messages) == (1, 1)


def verdict(growth, seconds) -> bool:
    """Whether memory is flat that has grown by `growth(t)` kB after t seconds."""
    times = np.arange(0.0, seconds, 0.2)
    pages = np.floor([growth(time) / 4.0 for time in times])
    samples = np.column_stack([times / 60.0, 75_000.0 + 4.0 * pages, 0.1 * times])
    result = soak.judge({}, {}, samples)
    assert result['passed'] == result['flat']
    return result['flat']


@pytest.mark.parametrize('seconds', [20.0, 120.0, 1800.0])
def test_memory_that_settles_or_has_grown_once_is_flat(seconds):
    assert verdict(lambda _: 0.0, seconds)
    assert verdict(lambda time: 1000.0 * (1.0 - math.exp(-10.0 * time / seconds)), seconds)
    for moment in (0.3, 0.5, 0.99):
        assert verdict(lambda time, moment=moment: 3000.0 * (time > moment * seconds), seconds)


@pytest.mark.parametrize(
    ('seconds', 'leak'), [(20.0, 64.0), (120.0, 16.0), (1800.0, 1.0)], ids=str
)
def test_memory_that_grows_with_every_message_is_not_flat(seconds, leak):
    # So many bytes a message, at 1 kHz.
    assert not verdict(lambda time: leak * time, seconds)
    assert not verdict(lambda time: leak * time + 30.0 * math.sin(time), seconds)


@pytest.mark.parametrize(
    ('lost', 'wrong', 'flat', 'code'),
    [(0, 0, True, 0), (1, 0, True, 1), (0, 1, True, 1), (0, 0, False, 1)],
)
def test_exit_code_tells_whether_all_is_well(
    monkeypatch, capsys, actuator, lost, wrong, flat, code
):
    topic = soak.Topic(soak.TOPICS['output_state'](actuator))
    topic.lost, topic.wrong = lost, wrong
    times = np.arange(100.0)
    samples = np.column_stack([times, times * (0.0 if flat else 1e6), times])
    monkeypatch.setattr(
        soak, 'soak', lambda *_: soak.judge({'sent': 1, 'rate': 1.0}, {'state': topic}, samples)
    )
    monkeypatch.setattr(sys, 'argv', ['soak.py'])
    assert soak.main() == code
    assert f'{lost} lost, {wrong} wrong' in capsys.readouterr().out

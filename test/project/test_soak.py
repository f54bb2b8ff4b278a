"""The soak: twenty seconds of it, and that it finds what it looks for."""

import json
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import soak
from geometry_msgs.msg import PoseArray
from rclpy.serialization import deserialize_message, serialize_message
from rotor_driver import counted_stamp, rotor_motion
from sensor_msgs.msg import JointState

from gear_kinematics.kinematics import RotorSample, split_turns
from gear_kinematics.state.state_messages import StateMessages

BENCHMARK = Path(__file__).resolve().parents[2] / 'benchmark'
SENT = 4  # messages
TOPICS = {
    'output_state': JointState,
    'body_poses': PoseArray,
    'mechanism_joint_states': JointState,
}


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


@pytest.fixture(scope='module')
def answers(actuator) -> dict[str, list]:
    """Give the messages that have to come, by topic."""
    messages = StateMessages(actuator, output_joint='output_shaft', frame_prefix='')
    given = {topic: [] for topic in TOPICS}
    for number in range(SENT):
        position, velocity, effort = rotor_motion(number)
        stamp = int(counted_stamp(number))
        sample = RotorSample(stamp, split_turns(position), velocity, effort)
        for topic, data in messages.encode(sample, TOPICS):
            given[topic].append(data)
    return given


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
def test_messages_that_are_missing_or_in_disorder_are_counted(
    actuator, answers, topic, order, lost, wrong
):
    messages = [answers[topic][number] for number in order]
    assert compare(actuator, topic, messages) == (lost, wrong)


def nudge(message):
    """Put a position off by twice what is allowed."""
    if isinstance(message, PoseArray):
        message.poses[-1].position.y += 2e-12 * 0.0011
    else:
        message.position[-1] += 2e-12


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


@pytest.mark.parametrize(('topic', 'kind'), TOPICS.items())
@pytest.mark.parametrize('damage', [nudge, date, rename, empty, None])
def test_damaged_message_is_found(actuator, answers, topic, kind, damage):
    messages = list(answers[topic])
    if damage is None:
        messages[1] = messages[1][:40]
    else:
        message = deserialize_message(messages[1], kind)
        damage(message)
        messages[1] = serialize_message(message)
    assert compare(actuator, topic, messages) == (1, 1)


def is_flat(growth, seconds) -> bool:
    """Whether memory is flat that has grown by `growth(t)` kB after t seconds."""
    times = np.arange(0.0, seconds, 0.2)
    pages = np.floor([growth(time) / 4.0 for time in times])
    samples = np.column_stack([times / 60.0, 75_000.0 + 4.0 * pages, 0.1 * times])
    result = soak.judge({}, {}, samples)
    assert result['passed'] == result['flat']
    return result['flat']


@pytest.mark.parametrize('seconds', [20.0, 120.0, 1800.0])
def test_memory_that_settles_or_has_grown_once_is_flat(seconds):
    assert is_flat(lambda time: 1000.0 * (1.0 - math.exp(-10.0 * time / seconds)), seconds)
    for moment in (0.3, 0.5, 0.99):
        assert is_flat(lambda time, moment=moment: 3000.0 * (time > moment * seconds), seconds)


@pytest.mark.parametrize(
    ('seconds', 'leak'), [(20.0, 64.0), (120.0, 16.0), (1800.0, 1.0)], ids=str
)
def test_memory_that_grows_with_every_message_is_not_flat(seconds, leak):
    # So many bytes a message, at 1 kHz.
    assert not is_flat(lambda time: leak * time + 30.0 * math.sin(time), seconds)

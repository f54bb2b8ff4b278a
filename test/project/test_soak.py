# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The soak: twenty seconds of it, and that it finds what it looks for."""

import json
import math
import os
import sys
from pathlib import Path

import numpy as np
import pytest
import soak
from blocked_bags import finished
from geometry_msgs.msg import PoseArray
from rclpy.serialization import deserialize_message, serialize_message
from rotor_driver import counted_stamp, rotor_motion
from sensor_msgs.msg import JointState
from wire import encoded

from gear_kinematics.kinematics import RotorSample, split_turns
from gear_kinematics.state.state_messages import StateMessages

BENCHMARK = Path(__file__).resolve().parents[2] / 'benchmark'
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
    command = [sys.executable, BENCHMARK / 'soak.py', '--minutes', 20 / 60, '--json']
    done = finished(command, timeout=240.0, env=environment)
    assert done.stdout, done.stderr
    result = json.loads(done.stdout)
    assert result['sent'] == 20_000
    assert result['lost'] == result['wrong'] == dict.fromkeys(TOPICS, 0)
    assert result['flat'], result['memory']
    assert done.returncode == 0


def nudge(message):
    """Put a position off by twice what is allowed."""
    if isinstance(message, PoseArray):
        message.poses[-1].position.y += 2e-12 * 0.0011
    else:
        message.position[-1] += 2e-12


@pytest.mark.parametrize(('topic', 'kind'), TOPICS.items())
def test_lost_disordered_and_wrong_messages_are_counted(actuator, topic, kind):
    states = StateMessages(actuator, output_joint='output_shaft', frame_prefix='')
    right = []
    for number in range(4):
        position, velocity, effort = rotor_motion(number)
        sample = RotorSample(int(counted_stamp(number)), split_turns(position), velocity, effort)
        right += encoded(states, sample, [topic]).values()
    moved = deserialize_message(right[1], kind)
    nudge(moved)
    a, b, c, d = right
    for messages, lost_and_wrong in (
        ([a, b, c, d], (0, 0)),
        ([a, c, d], (1, 0)),
        ([a, b, b, c, d], (0, 1)),
        ([a, c, b, d], (1, 1)),
        ([a, serialize_message(moved), c, d], (1, 1)),
        ([a, b[:40], c, d], (1, 1)),
    ):
        checked = soak.Topic(soak.TOPICS[topic](actuator))
        for message in messages:
            checked.add(message)
        checked.close(len(right))
        assert (checked.lost, checked.wrong) == lost_and_wrong


def is_flat(growth, seconds) -> bool:
    """Whether memory is flat that has grown by `growth(t)` kB after t seconds."""
    times = np.arange(0.0, seconds, 0.2)
    pages = np.floor([growth(time) / 4.0 for time in times])
    samples = np.column_stack([times / 60.0, 75_000.0 + 4.0 * pages, 0.1 * times])
    result = soak.judge({}, {}, samples)
    assert result['passed'] == result['flat']
    return result['flat']


@pytest.mark.parametrize('seconds', [20.0, 120.0, 1800.0])
def test_memory_is_flat_unless_it_grows_with_every_message(seconds):
    assert is_flat(lambda time: 1000.0 * (1.0 - math.exp(-10.0 * time / seconds)), seconds)
    for moment in (0.3, 0.99):
        assert is_flat(lambda time, moment=moment: 3000.0 * (time > moment * seconds), seconds)
    leak = 1800.0 / seconds  # bytes a message, at 1 kHz
    assert not is_flat(lambda time: leak * time + 30.0 * math.sin(time), seconds)

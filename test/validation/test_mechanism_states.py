# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""mechanism_joint_states of an arm, and in comparison with the matrix method."""

from dataclasses import replace

import numpy as np
import pytest
import replaying
from arm_recordings import OUTPUT, ROTOR, config, inputs
from node_loop import answered
from shipped_bags import BAGS, JOINT_STATE, read_bag, write_bag

from gear_kinematics.parameters.arm import load_actuators
from gear_kinematics.state.arm_state import ArmState
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.validation import explain
from gear_kinematics.validation.validate_bag import validate

STATES = 'mechanism_joint_states'
TOPIC = f'/{STATES}'
MARKERS, ERRORS = '/shoulder/markers', '/transmission_error'
LAST = 100
"""Number of a message with the joints of both mechanisms."""
JOINTS = 'rotor', 'satellite_a', 'satellite_b', 'oldham_a', 'oldham_b', 'output_shaft'


def changed(data: bytes, name: str, joint: int) -> bytes:
    """Flip one bit, in the exponent, of a joint's value in a field."""

    def flip(message) -> None:
        getattr(message, name).view(np.int64)[joint] ^= 1 << 62

    return replaying.edited(data, JOINT_STATE, flip)


@pytest.mark.parametrize('prefix', ['', 'left_'])
@pytest.mark.parametrize(
    ('field', 'joint', 'differing'),
    [
        ('position', None, ''),
        ('position', 'oldham_a', 'slide of joints'),
        ('velocity', 'output_shaft', 'velocity of joints'),
    ],
)
def test_joints_are_compared_independently(field, joint, differing, prefix, config, tmp_path):
    def off(message) -> None:
        if joint and len(values := getattr(message, field)):
            values[JOINTS.index(joint)] += 1e-6

    own, topics = replace(config, frame_prefix=prefix), [OUTPUT[1:], STATES]
    rotor = [message for message in read_bag(BAGS / 'driver_faults') if message[0] == ROTOR]
    messages = [
        (topic, received, replaying.edited(data, JOINT_STATE, off) if topic == TOPIC else data)
        for topic, received, data in answered(own, rotor, topics=topics)
    ]
    bag = write_bag(tmp_path / 'bag', messages, dict.fromkeys((ROTOR, OUTPUT, TOPIC), JOINT_STATE))
    found = validate(bag, config, independent=True).independent
    assert found.passed == (not differing)
    assert found.compared > 2000
    beyond = [name for name, error in found.errors.items() if error > 1e-12]
    assert beyond == [differing] * bool(differing)


def arm(path, edit=lambda _, data: data):
    """A recording of an arm of two mechanisms and a ratio, with two topics of other kinds."""
    actuators = {'shoulder.gear_ratio': '', 'elbow.gear_ratio': '', 'elbow.ring_teeth': 90}
    actuators = load_actuators(config(path / 'arm.yaml', **actuators))
    state = ArmState({name: GearState(each) for name, each in actuators.items()})
    state.choose([OUTPUT[1:], STATES])
    messages = [(MARKERS, 0, b''), (ERRORS, 0, b'')]
    for stamp, joints in inputs(40):
        data = joints.encode(stamp)
        messages.append((ROTOR, stamp, data))
        for topic, answer in state.encode(state.rotor(data, int)[0]):
            given = edit(len(messages), answer) if topic == STATES else answer
            messages.append((f'/{topic}', stamp + 1, given))
    types = dict.fromkeys((ROTOR, OUTPUT, TOPIC, ERRORS), JOINT_STATE) | {
        MARKERS: 'visualization_msgs/msg/MarkerArray'
    }
    bag = write_bag(path / 'bag', messages, types)
    return validate(bag, path / 'arm.yaml', independent=True)


def test_joints_of_an_arm_are_compared_each_and_other_topics_are_named(tmp_path):
    report = arm(tmp_path)
    assert report.passed, explain(report)
    assert 'recorded, but not compared: transmission_error, markers' in explain(report)
    compared = [
        [topic.compared for topic in each.topics if topic.topic == TOPIC]
        for each in report.actuators
    ]
    assert compared == [[40], [40], []]
    assert [each.independent.compared for each in report.actuators] == [80, 80, 40]
    assert all(max(each.independent.errors.values()) < 1e-13 for each in report.actuators)


@pytest.mark.parametrize('edit', ['a bit', 'no joint'])
def test_a_fault_of_one_joint_of_an_arm_is_that_of_its_actuator(edit, tmp_path):
    def drop_last(message) -> None:
        for field in ('name', 'position', 'velocity'):
            setattr(message, field, getattr(message, field)[: len(JOINTS)])

    def edited(number, data):
        if number != LAST:
            return data
        if edit == 'a bit':
            return changed(data, 'velocity', len(JOINTS) + 3)
        return replaying.edited(data, JOINT_STATE, drop_last)

    report = arm(tmp_path, edited)
    assert [each.verdict for each in report.actuators] == ['pass', 'fail', 'pass']
    text = explain(report.actuators[1])
    assert TOPIC in text
    assert ('slide velocity: error' if edit == 'a bit' else 'the joint is missing') in text
    passed = [each.independent.passed for each in report.actuators]
    assert passed == [True, edit == 'no joint', True]

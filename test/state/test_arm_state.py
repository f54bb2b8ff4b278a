# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""An arm: each message gives one of each topic, with what every gear alone would give."""

import math
from dataclasses import replace

import pytest
from calibrations import calibration
from geometry_msgs.msg import PoseArray
from live import SECOND, rotor_bytes, stamp_of
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

from gear_kinematics.parameters.arm import actuators_of
from gear_kinematics.state.arm_state import ArmState
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.state.monitors import Connections, DriverFacts
from gear_kinematics.state.statuses import Condition

START, PERIOD = 100 * SECOND, SECOND // 100
GIVEN = {
    'actuators': ['shoulder', 'elbow', 'wrist'],
    'rotor_joint': '',  # each has its own
    'shoulder.rotor_joint': 'm1',
    'elbow.rotor_joint': 'm2',
    'wrist.rotor_joint': 'm3',
    'elbow.gear_ratio': '-58/3',
    'elbow.rotor_direction': -1,
    'elbow.rotor_zero': 0.5,
    'wrist.preload': 3.0,
    'wrist.branch_stiffness': [2000.0],
    'wrist.frame_prefix': 'left_',
}
RATIOS = {'shoulder': -19.0, 'elbow': -58 / 3, 'left_wrist': -19.0}


@pytest.fixture
def arm():
    """Return an arm of three gears, of which one has a calibration, with all topics chosen."""
    found = {
        name: GearState(each, calibration() if name == 'shoulder' else None)
        for name, each in actuators_of(GIVEN).items()
    }
    arm = ArmState(found)
    arm.choose(arm.topics)
    return arm


def answer(arm, data, now=lambda: 7 * SECOND):
    """Return the messages of a rotor message by topic, and the causes by actuator."""
    answered, rejections = arm.rotor(data, now)
    faults = {name: str(rejection) for name, rejection in rejections}
    encoded = arm.encode(answered) if answered else []
    topics = [topic for topic, _ in encoded]
    assert len(topics) == len(set(topics))
    return dict(encoded), faults


def state(data):
    return deserialize_message(data, JointState)


def test_one_message_has_the_joints_in_the_order_of_the_actuators(arm):
    data = rotor_bytes(START, ['m3', 'x', 'm2', 'm1'], [3.0, 9.0, 2.0, 1.0], [0.3, 9.0, 0.2, 0.1])
    encoded, faults = answer(arm, data)
    assert faults == {}
    output = state(encoded['output_state'])
    assert (output.name, stamp_of(output)) == (list(RATIOS), START)
    rotor = 1.0, -(2.0 - 0.5), 3.0
    expected = [angle / ratio for angle, ratio in zip(rotor, RATIOS.values(), strict=True)]
    assert list(output.position) == pytest.approx(expected, rel=1e-15)
    rates = [r / ratio for r, ratio in zip((0.1, -0.2, 0.3), RATIOS.values(), strict=True)]
    assert list(output.velocity) == pytest.approx(rates, rel=1e-15)
    assert list(output.effort) == []
    joints = state(encoded['mechanism_joint_states']).name
    inner = [f'{kind}_{branch}' for kind in ('satellite', 'oldham') for branch in 'ab']
    names = ['rotor', *inner]
    assert joints == [
        *(f'shoulder_{name}' for name in names),
        'shoulder',
        *(f'left_{name}' for name in names),
        'left_wrist',
    ]
    assert state(encoded['corrected_state']).name == ['shoulder']
    assert encoded.keys() == {
        'output_state', 'mechanism_joint_states', 'corrected_state', 'corrected_interval',
        'shoulder/body_poses', 'wrist/body_poses',
    }  # fmt: skip
    for name, frame in (('shoulder', 'shoulder_stator'), ('wrist', 'left_stator')):
        poses = deserialize_message(encoded[f'{name}/body_poses'], PoseArray)
        assert (poses.header.frame_id, len(poses.poses)) == (frame, 4)


def test_each_joint_has_to_the_last_bit_what_its_gear_alone_gives(arm):
    """In every field of every topic, which NaN fills for the joints that lack it."""
    alone = {}
    for name, each in actuators_of(GIVEN).items():
        alone[name] = GearState(each, calibration() if name == 'shoulder' else None)
        alone[name].choose(alone[name].topics)
    order = {name: number for number, name in enumerate(alone)}
    for k in range(60):
        stamp = START + k * PERIOD
        angles = [0.1 * k, math.sin(0.1 * k), 0.3 * k]
        effort = [0.1, math.nan, 0.2 + 0.01 * k] if k % 3 else []
        data = rotor_bytes(stamp, ['m1', 'm2', 'm3'], angles, [], effort)
        encoded, _ = answer(arm, data)
        assert 'output_state' in encoded
        wanted = {}
        for name, gear in alone.items():
            gear.rotor(data, int)
            for topic, message in gear.encode():
                wanted.setdefault(topic, []).append((name, message))
        for topic, parts in wanted.items():
            if topic in ('body_poses', 'joint_loads'):
                for name, message in parts:
                    assert encoded.pop(f'{name}/{topic}') == message
                continue
            whole, place = state(encoded.pop(topic)), 0
            assert [name for name, _ in parts] == sorted(dict(parts), key=order.get)
            fields = [state(message) for _, message in parts]
            for one in fields:
                end = place + len(one.name)
                assert whole.name[place:end] == one.name
                for field in ('position', 'velocity', 'effort'):
                    given, there = getattr(one, field), getattr(whole, field)
                    if not any(len(getattr(each, field)) for each in fields):
                        assert not len(there)
                    elif len(given):
                        assert list(there[place:end]) == list(given)
                    else:
                        assert all(map(math.isnan, there[place:end]))
                place = end
            assert place == len(whole.name)
        assert not encoded


def test_joints_that_are_missing_or_wrong_leave_the_others_alone(arm):
    for number, (names, positions, valid, causes) in enumerate(
        (
            (['m2'], [1.0], ['elbow'], {}),
            (['m3', 'm1'], [math.nan, 1.0], ['shoulder'], {'wrist': 'position not finite'}),
            (['m1', 'm2', 'm3'], [1.0] * 3, list(RATIOS), {}),
            (['other'], [1.0], [], dict.fromkeys(arm.actuators, 'joint missing')),
            (['m1', 'm2'], [1.0], [], dict.fromkeys(('shoulder', 'elbow'), 'array sizes')),
        )
    ):  # fmt: skip
        encoded, faults = answer(arm, rotor_bytes(START + number * PERIOD, names, positions))
        assert (state(encoded['output_state']).name if valid else []) == valid
        assert faults == causes
    _, faults = answer(arm, b'no message')
    assert set(faults.values()) == {'not a JointState'}
    for name, received, others, rejected in (
        ('shoulder', 6, 2, {'array sizes': 1, 'not a JointState': 1}),
        ('elbow', 6, 2, {'array sizes': 1, 'not a JointState': 1}),
        ('wrist', 6, 3, {'position not finite': 1, 'not a JointState': 1}),
    ):
        rotor = arm.actuators[name].input
        assert (rotor.received, rotor.of_others, rotor.rejected) == (received, others, rejected)


def test_message_without_a_stamp_has_one_time_for_all_joints(arm):
    clock = iter(range(START, START + 100))
    encoded, _ = answer(arm, rotor_bytes(0, ['m1', 'm2'], [1.0, 2.0]), lambda: next(clock))
    assert stamp_of(state(encoded['output_state'])) == START
    assert arm.actuators['elbow'].input.last.stamp == START


def test_errors_of_the_outputs_come_in_one_message_for_each_stamp(arm):
    """Error = measured - ideal: both outputs are 0.01 rad ahead, and the wrist has no encoder."""
    ahead = 0.01
    for k in range(3):
        stamp = START + k * PERIOD
        arm.rotor(rotor_bytes(stamp, ['m1', 'm2', 'm3'], [0.19 * k, 0.5, 1.0]), int)
        measured = rotor_bytes(stamp, ['elbow', 'shoulder'], [ahead, ahead - 0.01 * k])
        errors, rejections = arm.encoder(measured, int)
    assert ([name for name, _ in errors], rejections) == (['shoulder', 'elbow'], [])
    [(topic, data)] = arm.encode_errors(errors)
    error = state(data)
    assert (topic, error.name) == ('transmission_error', ['shoulder', 'elbow'])
    assert stamp_of(error) == START + 2 * PERIOD
    assert list(error.position) == pytest.approx([ahead, ahead], rel=1e-12)
    assert not arm.actuators['wrist'].output_encoder.received


def test_what_is_known_of_a_driver_is_reported_of_each_actuator_once(arm):
    connections = Connections(DriverFacts(since=0.0, publishers=1, lost=3))
    answer(arm, rotor_bytes(START, ['m1', 'm2'], [1.0, 2.0]))
    for state in arm.actuators.values():
        state.monitor.last_input = 0.5
    for facts in ([Condition.LOST(count=3)], []):
        reports = arm.report(1.0, connections)
        assert [*reports] == [f'{name}: rotor input' for name in arm.actuators]
        assert [report.facts for report in reports.values()] == [facts] * 3
        counts = [(r.values['lost messages'], r.values['of others']) for r in reports.values()]
        assert counts == [(3, 0), (3, 0), (3, 1)]


def test_a_change_of_a_joint_is_followed(arm):
    changed = replace(arm.actuators['elbow'].parameters, rotor_joint='m9')
    arm.apply('elbow', changed, None)
    encoded, _ = answer(arm, rotor_bytes(START, ['m2', 'm9'], [1.0, 2.0]))
    assert list(state(encoded['output_state']).position) == pytest.approx([1.5 * 3 / 58])

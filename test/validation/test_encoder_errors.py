# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The recorded transmission errors are those of the recorded encoders."""

import math

import pytest
import replaying
from arm_recordings import OUTPUT, RATIOS, ROTOR, config
from live import rotor_bytes
from node_loop import ENCODER
from shipped_bags import JOINT_STATE, write_bag

from gear_kinematics.bag import Bag
from gear_kinematics.parameters.arm import load_actuators
from gear_kinematics.state.arm_state import ArmState
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.validation import explain
from gear_kinematics.validation.compute import compute
from gear_kinematics.validation.findings import findings
from gear_kinematics.validation.validate_bag import validate

ERRORS = '/transmission_error'
MILLISECOND = 1_000_000  # ns


def recording(actuators, homed: int = -1) -> list[tuple[str, int, bytes]]:
    """What a node hears and publishes: rotors at 500 Hz, encoders 0.7 ms later at 250 Hz."""
    arm = ArmState({name: GearState(each) for name, each in actuators.items()})
    arm.choose([OUTPUT[1:], ERRORS[1:]])
    messages, names = [], list(RATIOS)

    def publish(answers) -> None:
        messages.extend((f'/{topic}', messages[-1][1] + 1000, data) for topic, data in answers)

    for k in range(1, 500):
        stamp, time = 2 * k * MILLISECOND, 0.002 * k
        angles = [40.0 * math.sin(time), 90.0 * time, math.cos(3.0 * time)]
        if k == homed:
            for state in arm.actuators.values():
                state.input.home(0.0)
                state.output_encoder.configure(state.parameters)
        data = rotor_bytes(stamp, names, angles)
        messages.append((ROTOR, stamp + 1000, data))
        publish(arm.encode(arm.rotor(data, int)[0]))
        if k % 2:
            later = stamp + 7 * MILLISECOND // 10
            measured = [a / float(r) + 0.01 for a, r in zip(angles, RATIOS.values(), strict=True)]
            joints = [each.output_encoder_joint for each in actuators.values()]
            data = rotor_bytes(later, joints, measured)
            messages.append((ENCODER, later + 1000, data))
            publish(arm.encode_errors(arm.encoder(data, int)[0]))
    return messages


def judged(path, messages, **more):
    own = {f'{name}.output_encoder_joint': name for name in RATIOS}
    file = config(path / 'arm.yaml', **(own | more))
    recorded = messages(load_actuators(file))
    topics = dict.fromkeys((topic for topic, *_ in recorded), JOINT_STATE)
    return validate(write_bag(path / 'bag', recorded, topics), file)


@pytest.mark.parametrize('homed', [-1, 251])
def test_errors_of_a_node_agree(homed, tmp_path):
    report = judged(tmp_path, lambda actuators: recording(actuators, homed))
    assert report.passed, explain(report)
    text = explain(report)
    for name in RATIOS:
        assert f'{name}: {ERRORS}: both encoders confirm 24' in text
    assert 'not compared' not in text


@pytest.mark.parametrize('value', [lambda error: error + 1e-6, lambda _: math.nan])
def test_one_error_that_differs_fails_its_actuator(value, tmp_path):
    def edit(message) -> None:
        message.position[1] = value(message.position[1])

    def messages(actuators):
        found = recording(actuators)
        row = [k for k, message in enumerate(found) if message[0] == ERRORS][100]
        found[row] = *found[row][:2], replaying.edited(found[row][2], JOINT_STATE, edit)
        return found

    report = judged(tmp_path, messages)
    assert [each.passed for each in report.actuators] == [True, False, True]
    assert f'elbow: {ERRORS}: error ' in explain(report)


def test_what_the_recorder_lost_is_not_judged(tmp_path):
    """Where a rotor state is missing, the node had another one between which it interpolated."""

    def messages(actuators):
        lost = {k * 2 * MILLISECOND + 1000 for k in range(7, 480, 50)}
        return [m for m in recording(actuators) if m[0] != ROTOR or m[1] not in lost]

    report = judged(tmp_path, messages)
    assert report.passed, explain(report)
    assert ': both encoders confirm 2' in explain(report)


def test_errors_without_the_encoder_are_not_compared(tmp_path):
    def messages(actuators):
        return [message for message in recording(actuators) if message[0] != ENCODER]

    report = judged(tmp_path, messages)
    assert report.passed, explain(report)
    assert 'recorded, but not compared: transmission_error' in explain(report)


def test_an_encoder_whose_topic_was_remapped_is_found_by_its_joints(tmp_path):
    def messages(actuators):
        renamed = {ENCODER: '/arm/encoders'}
        return [(renamed.get(topic, topic), *rest) for topic, *rest in recording(actuators)]

    joints = {f'{name}.output_encoder_joint': f'{name}_encoder' for name in RATIOS}
    report = judged(tmp_path, messages, **joints)
    assert explain(report).count(f'{ERRORS}: both encoders confirm 24') == len(RATIOS)


def test_errors_of_other_outputs_are_not_kept_beside_computed_ones(tmp_path):
    """The recorded node was homed, which computed outputs are not."""
    assert judged(tmp_path, lambda actuators: recording(actuators, 251)).passed
    file, computed = tmp_path / 'arm.yaml', tmp_path / 'computed'
    with Bag(tmp_path / 'bag') as bag:
        result = compute(bag, computed, load_actuators(file))
    assert result.left_out == (ERRORS,)
    report = validate(computed, file)
    assert report.passed, explain(report)


def test_a_message_that_is_none_fails(tmp_path):
    report = judged(tmp_path, lambda actuators: [*recording(actuators), (ERRORS, 10**9, b'')])
    assert not report.passed


def test_another_ratio_is_named_before_the_errors_that_follow_from_it(tmp_path):
    judged(tmp_path, recording)
    own = {f'{name}.output_encoder_joint': name for name in RATIOS}
    other = config(tmp_path / 'other.yaml', **own, **{'elbow.gear_ratio': '1457/27'})
    report = validate(tmp_path / 'bag', other)
    (elbow,) = (each for each in report.actuators if each.actuator == 'elbow')
    first, *rest = (found.text for found in findings(elbow))
    assert first.startswith('the recorded ratio is 1457/26, not 1457/27')
    assert any('against the encoders' in text for text in rest)

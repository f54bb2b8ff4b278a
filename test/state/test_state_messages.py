# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The published messages against the motion at 50 digits, and their layout."""

import math
from dataclasses import replace
from itertools import combinations

import oracle
import pytest
from geometry_msgs.msg import PoseArray
from hypothesis import given, settings
from hypothesis import strategies as st
from properties import mechanisms, numbers_of
from rclpy.serialization import deserialize_message
from replaying import assert_poses
from sensor_msgs.msg import JointState
from wire import encoded, of_rows

from gear_kinematics.correction.corrector import Correction
from gear_kinematics.kinematics import RotorPosition, RotorSample, solve, split_turns
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.state_messages import StateMessages, state_messages
from gear_kinematics.wire.joint_reader import GREATEST

STAMP = 12_345_678_901
NAMES = {'output_joint': 'output_shaft', 'frame_prefix': ''}
PARAMETERS = replace(NodeParameters.load(), rotor_joint='')
TYPES = {'output_state': JointState, 'body_poses': PoseArray, 'mechanism_joint_states': JointState}
DIGITS = 1e-12  # of the eccentricity, of a radian within the turn
LARGEST_ANGLE = 2**51 * math.tau  # rad: the node takes no position beyond
TINY = 1e-20  # rates below: the oracle differentiates numerically, at 50 digits


def encode(mechanism, sample, names=NAMES):
    """The three messages as deserialised by rclpy."""
    messages = encoded(StateMessages(mechanism, **names), sample)
    assert list(messages) == list(TYPES)
    return [deserialize_message(messages[topic], kind) for topic, kind in TYPES.items()]


def sample_at(rotor_angle, velocity=None, effort=None) -> RotorSample:
    return RotorSample(STAMP, split_turns(rotor_angle), velocity, effort)


def assert_joint_states(message, derivatives, numbers, *, velocity: bool) -> None:
    """Compare mechanism_joint_states with the oracle."""
    expected, rates = derivatives.value, derivatives.first
    count, e = len(numbers.branches), numbers.eccentricity
    angles, slides = message.position[: 1 + count], message.position[1 + count : -1]
    assert oracle.angle_error(message.position[-1], expected.output_angle) <= DIGITS
    for k, branch in enumerate(expected.branches):
        turned = angles[0] + angles[1 + k]
        assert oracle.turn_angle_error(turned, branch.satellite_angle) <= DIGITS
        assert oracle.length_error(slides[k], branch.satellite_slide, e) <= DIGITS
    if not velocity:
        assert len(message.velocity) == 0
        return
    speed = message.velocity[0]
    scale = abs(speed) + abs(message.velocity[-1]) + TINY
    assert oracle.angle_error(message.velocity[-1], rates.output_angle) <= 1e-14 * scale
    for k, branch in enumerate(rates.branches):
        turned = message.velocity[1 + k] + speed
        assert oracle.angle_error(turned, rates.output_angle) <= 1e-14 * scale
        slide = message.velocity[1 + count + k]
        assert oracle.length_error(slide, branch.satellite_slide, e) <= 1e-12 * scale


@pytest.mark.slow
@settings(max_examples=60)
@given(mechanisms(), st.floats(-20.0, 20.0), st.floats(-700.0, 700.0))
def test_messages_hold_the_motion(mechanism, rotor_angle, velocity):
    # The output of 2:1 turns as fast as the rotor, that of 400:1 399 times: few turns of both.
    rotor_angle /= max(1.0, float(abs(1 / mechanism.gear_ratio)))
    numbers = numbers_of(mechanism)
    state, poses, joints = encode(mechanism, sample_at(rotor_angle, velocity))
    exact = oracle.rotor_angle_of(rotor_angle)
    derivatives = oracle.expected_derivatives(numbers, exact, velocity, 0.0)
    expected = derivatives.value
    assert oracle.angle_error(state.position[0], expected.output_angle) <= DIGITS
    output_rate = derivatives.first.output_angle
    assert oracle.angle_error(state.velocity[0], output_rate) <= 1e-14 * abs(output_rate) + TINY
    assert_poses(poses.poses, expected, numbers)
    assert joints.position[0] == pytest.approx(rotor_angle, abs=1e-14)
    assert joints.velocity[0] == velocity
    assert_joint_states(joints, derivatives, numbers, velocity=True)


@pytest.mark.parametrize('velocity', [None, 3.8])
@pytest.mark.parametrize('effort', [None, 0.5])
def test_fields_that_the_input_lacks_stay_empty(actuator, velocity, effort):
    # 80/76 teeth: i = -19, by hand.
    state, _, joints = encode(actuator, sample_at(1.9, velocity, effort))
    assert list(state.name) == ['output_shaft']
    assert list(state.position) == [pytest.approx(-0.1, abs=1e-16)]
    assert list(state.velocity) == ([] if velocity is None else [pytest.approx(-0.2)])
    assert list(state.effort) == ([] if effort is None else [pytest.approx(-9.5)])
    assert len(joints.velocity) == (0 if velocity is None else len(joints.name))
    assert len(joints.effort) == 0


@pytest.mark.parametrize('topics', [subset for n in range(4) for subset in combinations(TYPES, n)])
def test_only_selected_topics_are_encoded(actuator, topics):
    messages = StateMessages(actuator, **NAMES)
    sample = sample_at(1.9, 3.8, 0.5)
    every = encoded(messages, sample)
    assert list(encoded(messages, sample, topics).items()) == [(t, every[t]) for t in topics]


@pytest.mark.parametrize('stamp', [0, 1, STAMP, -1, 2**31 * 10**9 - 1])
def test_every_message_has_the_stamp_of_the_sample(actuator, stamp):
    for message in encode(actuator, sample_at(0.0)._replace(stamp=stamp)):
        header = message.header.stamp
        assert (header.sec, header.nanosec) == divmod(stamp, 10**9)


@settings(max_examples=80)
@given(mechanisms(), st.floats(-LARGEST_ANGLE, LARGEST_ANGLE), st.floats(-1e4, 1e4))
def test_messages_have_the_bits_of_a_batch(mechanism, position, velocity):
    sample = sample_at(position, velocity)
    state, poses, joints = encode(mechanism, sample)
    batch = solve(mechanism, [position], velocity, rotor_turns=[0.0])
    assert state.position[0] == joints.position[-1] == batch.output_angle[0]
    assert state.velocity[0] == joints.velocity[-1] == batch.output_velocity[0]
    places = [[pose.position.x, pose.position.y] for pose in poses.poses]
    assert places == [*batch.satellite_centre[0].tolist(), *batch.oldham_centre[0].tolist()]
    slides = slice(1 + len(mechanism.branches), -1)
    assert joints.position[slides].tolist() == batch.satellite_slide[0].tolist()
    assert joints.velocity[slides].tolist() == batch.satellite_slide_velocity[0].tolist()


@given(mechanisms(), st.floats(-LARGEST_ANGLE, LARGEST_ANGLE), st.floats(-1e280, 1e280))
def test_no_number_is_too_large_to_be_encoded(mechanism, position, rate):
    state, poses, _ = encode(mechanism, sample_at(position, rate, rate))
    assert math.isfinite(state.position[0])
    assert len(poses.poses) == 2 * len(mechanism.branches)


rates = st.none() | st.floats(-1e280, 1e280)
CORRECTIONS = st.tuples(
    st.floats(-0.1, 0.1), st.floats(-2.0, 2.0), st.floats(0.0, 0.1), st.just(0.0)
)
CORRECTED = ('corrected_state', 'corrected_interval')


def encode_corrected(states, sample, correction, topics=CORRECTED):
    return of_rows(states.corrected_rows(sample, correction, topics), sample.stamp)


@pytest.mark.parametrize(('velocity', 'effort'), [(3.0, -0.5), (None, 0.25), (2.0, None)])
def test_of_a_gear_with_only_a_ratio_there_is_the_output_alone(velocity, effort):
    """4 × 58 turns and an angle: the output makes 12 turns backwards, and 3/58 of the angle."""
    messages = state_messages(replace(PARAMETERS, gear_ratio='-58/3'))
    sample = RotorSample(7, RotorPosition(4 * 58, 0.5), velocity, effort)
    state = deserialize_message(
        encoded(messages, sample, ['output_state'])['output_state'], JointState
    )
    assert list(state.position) == [pytest.approx(-12 * math.tau - 0.5 * 3 / 58, rel=1e-15)]
    rates = [] if velocity is None else [pytest.approx(-velocity * 3 / 58, rel=1e-15)]
    torques = [] if effort is None else [pytest.approx(-effort * 58 / 3, rel=1e-15)]
    assert (list(state.velocity), list(state.effort)) == (rates, torques)


@pytest.mark.parametrize('name', ['', 'a\nb'])
@pytest.mark.parametrize('ratio', ['', '5'])
def test_name_that_is_no_joint_is_refused_for_every_gear(name, ratio):
    with pytest.raises(ValueError, match='output_joint'):
        state_messages(replace(PARAMETERS, output_joint=name, gear_ratio=ratio))


@given(mechanisms(), st.floats(-1e3, 1e3), rates, rates, CORRECTIONS)
def test_corrected_state_is_the_output_state_and_the_correction(
    mechanism, position, velocity, effort, correction
):
    states = StateMessages(mechanism, output_joint='left/output_shaft', frame_prefix='left/')
    sample = sample_at(position, velocity, effort)
    [ideal] = encoded(states, sample, ['output_state']).values()
    messages = encode_corrected(states, sample, Correction(*correction))
    assert tuple(messages) == CORRECTED
    for topic, data in messages.items():  # or only one of them
        alone = encode_corrected(states, sample, Correction(*correction), [topic])
        assert alone == {topic: data}
    ideal, corrected, interval = (
        deserialize_message(data, JointState) for data in (ideal, *messages.values())
    )
    deviation, slope, half_width, _ = correction
    assert corrected.name == interval.name == ['left/output_shaft']
    assert corrected.header == interval.header == ideal.header
    assert list(corrected.position) == [ideal.position[0] + deviation]
    expected = [rate * (1.0 + slope) for rate in ideal.velocity]
    assert list(corrected.velocity) == pytest.approx(expected, rel=1e-14)
    assert corrected.effort == ideal.effort
    assert list(interval.position) == [half_width]
    assert not interval.velocity
    assert not interval.effort


@pytest.mark.parametrize('ratio', ['-9007199254740992', '1/9007199254740992'])
def test_corrected_state_is_finite_for_every_ratio_and_slope(ratio):
    states = state_messages(replace(PARAMETERS, gear_ratio=ratio))
    sample = sample_at(1.0, GREATEST, -GREATEST)
    messages = encode_corrected(states, sample, Correction(0.1, 1e6, 0.1, 0.0))
    corrected = deserialize_message(messages['corrected_state'], JointState)
    assert all(map(math.isfinite, [*corrected.velocity, *corrected.effort]))

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The rotor's state from the output's: at 50 digits, and forwards again."""

import math

import mpmath
import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from gear_kinematics.kinematics import GearRatio, rotor_state_for, solve

RATIOS = st.builds(
    lambda numerator, denominator, sign: GearRatio(sign * numerator, denominator),
    st.integers(1, 10_000_000), st.integers(1, 1000), st.sampled_from((-1, 1)),
)  # fmt: skip
STATES = {
    'ratio': RATIOS,
    'turns': st.integers(-(2**40), 2**40),
    'angle': st.floats(-math.pi, math.pi),
}
FAR = {'ratio': GearRatio(1457, 26), 'turns': 2**40, 'angle': 3.0}
NEAR = {'ratio': GearRatio(-19), 'turns': 0, 'angle': math.pi}


def apart(exact, turns, angle) -> float:
    return abs(float(exact - 2 * mpmath.pi * int(turns) - mpmath.mpf(float(angle))))


@given(**STATES)
@example(**FAR)
@example(**NEAR)
def test_rotor_is_at_the_ratio_times_the_output_and_forwards_again_at_the_same(
    ratio, turns, angle
):
    assume(abs(turns * ratio) < 2**51)
    rotor = rotor_state_for(ratio, angle, turns=turns)
    again = ratio.output_angle(rotor.turns, rotor.angle, math)
    with mpmath.workdps(50):
        output = 2 * mpmath.pi * turns + mpmath.mpf(angle)
        exact = output * ratio.numerator / ratio.denominator
        error = apart(exact, rotor.turns, rotor.angle)
        error_again, rounded = apart(output, *again), float(exact)
    assert error <= 2e-15 * (1.0 + 2.0 * abs(float(ratio)))  # a last bit of the output, geared up
    assert error_again <= 4e-15 * (1.0 + 1.0 / abs(float(ratio)))
    assert abs(rotor.angle) <= math.pi * (1.0 + 1e-15)
    assert abs(rotor.position - rounded) <= error + 2.0 * math.ulp(rounded)


@pytest.mark.parametrize(
    ('ratio', 'output', 'rotor'),
    [  # ω2 = i ω5 and τ2 = τ5/i: what goes in as power comes out
        ('-19', (2.0, 38.0), (-38.0, -2.0)),
        ('1457/26', (26.0, -1457.0), (1457.0, -26.0)),
        ('1/4', (8.0, 0.5), (2.0, 2.0)),
        ('121', (0.0, 0.0), (0.0, 0.0)),
    ],
)
def test_velocity_is_geared_up_and_effort_down(ratio, output, rotor):
    assert rotor_state_for(GearRatio.parse(ratio), 0.5)[2:] == (None, None)
    assert rotor_state_for(GearRatio.parse(ratio), 0.0, *output)[2:] == rotor


@given(**STATES)
def test_arrays_give_what_floats_do_to_the_last_bit(ratio, turns, angle):
    many = rotor_state_for(
        ratio, np.array([[0.0, angle]]), np.array([[1.0, angle]]), np.array([[2.0, angle]]),
        turns=np.array([[0.0, turns]]),
    )  # fmt: skip
    one = rotor_state_for(ratio, angle, angle, angle, turns=turns)
    assert tuple(values[0, 1] for values in many) == one
    assert many.position[0, 1] == one.position


def test_mechanism_and_its_motion_are_inverse(actuator):
    angles = np.linspace(-100.0, 100.0, 999)
    rotor = rotor_state_for(actuator, angles, 1.5)
    motion = solve(actuator, rotor.angle, rotor.velocity, rotor_turns=rotor.turns)
    np.testing.assert_allclose(motion.output_angle, angles, rtol=3e-16, atol=1e-15)
    np.testing.assert_allclose(motion.output_velocity, 1.5, rtol=3e-16)


@pytest.mark.parametrize('angle', [math.nan, math.inf, 2.0**51 * 7.0])
def test_an_angle_without_meaning_is_refused(angle):
    with pytest.raises(ValueError, match='an angle is at most'):
        rotor_state_for(GearRatio(-19), angle)
    assert np.isnan(rotor_state_for(GearRatio(-19), np.array([angle])).position).all()

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The gear ratio: its text, its exact output angle, and the fractions and teeth in an interval."""

import copy
import math
import pickle
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from gear_kinematics.kinematics import GearRatio, rotor_state_for
from gear_kinematics.kinematics.gear_ratio import simplest_fraction, tooth_pairs

RATIOS = st.builds(
    lambda numerator, denominator, sign: GearRatio(sign * numerator, denominator),
    st.integers(1, 10_000_000),
    st.integers(1, 100_000_000),
    st.sampled_from((-1, 1)),
)


@pytest.mark.parametrize(('text', 'ratio'), [
    ('-19', Fraction(-19)), ('+19', Fraction(19)), ('1457/26', Fraction(1457, 26)),
    ('-58/3', Fraction(-58, 3)), ('38/2', Fraction(19)), ('28.8', Fraction(144, 5)),
    ('-0.1', Fraction(-1, 10)),
])  # fmt: skip
def test_text_is_read_exactly(text, ratio):
    assert GearRatio.parse(text) == ratio


@pytest.mark.parametrize(
    'text', ['', 'x', '19:1', '1e3', 'nan', '1/2/3', '1/-2', '1.5/2', '19 ', '٣', '1_0', '--1']
)
def test_text_that_is_no_ratio_is_refused(text):
    with pytest.raises(ValueError, match='integer, a fraction or a decimal, such as'):
        GearRatio.parse(text)


@pytest.mark.parametrize(('text', 'cause'), [
    ('0', 'a gear ratio must not be 0'), ('-0/5', 'a gear ratio must not be 0'),
    ('0.0', 'a gear ratio must not be 0'), ('1/0', 'denominator of a gear ratio must not be 0'),
    ('9007199254740993', r'must not exceed 2\^53'),
    ('3000000001/3000000000', r'must not exceed 2\^53'),
])  # fmt: skip
def test_ratio_that_no_gear_has_is_refused(text, cause):
    with pytest.raises(ValueError, match=f'{cause}, not {text!r}'):
        GearRatio.parse(text)


def test_a_copy_is_a_ratio():
    ratio = GearRatio(-58, 3)
    stored = pickle.loads(pickle.dumps(ratio))  # noqa: S301, its own bytes
    for again in (copy.copy(ratio), copy.deepcopy(ratio), stored):
        assert again == ratio
        assert again.output_angle(1, 0.5, math) == ratio.output_angle(1, 0.5, math)
    assert ratio.gear_ratio is ratio


@given(RATIOS, st.integers(-(2**52), 2**52), st.floats(-math.pi, math.pi))
@example(GearRatio(1457, 26), 2**52, 3.0)
@example(GearRatio(-26, 1457), 2**40, -3.0)
@example(GearRatio(1), 0, math.pi)
@example(GearRatio(19), 20890720927753, 3.14159265358)  # just beyond half a turn of the output
def test_output_angle_is_that_of_50_digits(ratio, turns, angle):
    output_turns, rest = ratio.output_angle(turns, angle, math)
    with mpmath.workdps(50):
        exact = (2 * mpmath.pi * turns + mpmath.mpf(angle)) * ratio.denominator / ratio.numerator
        off = exact - 2 * mpmath.pi * output_turns - mpmath.mpf(rest)
        within = abs(off - 2 * mpmath.pi * mpmath.nint(off / (2 * mpmath.pi)))
    # The rotor's angle is rounded, and the output turns that much further.
    rounding = 2e-15 * (1.0 + 2.0 / abs(float(ratio)))
    assert abs(rest) <= math.pi * (1.0 + 1e-15)
    assert within <= rounding
    if abs(output_turns) < 2**52:
        assert abs(off) <= rounding


@given(RATIOS, st.integers(-(2**52), 2**52), st.floats(-math.pi, math.pi))
@example(GearRatio(19), 20890720927753, 3.14159265358)
def test_floats_and_arrays_agree_to_the_last_bit(ratio, turns, angle):
    many = ratio.output_angle(np.array([0.0, turns]), np.array([1.0, angle]), np)
    assert ratio.output_angle(turns, angle, math) == (many[0][1], many[1][1])
    assert ratio.output_rate(angle) == ratio.output_rate(np.array([angle]))[0]


@given(RATIOS, st.floats(-1e3, 1e3))
def test_rotor_angle_is_the_ratio_times_the_output_angle(ratio, output_angle):
    exact = float(Fraction(output_angle) * Fraction(ratio))
    assert ratio.rotor_angle(output_angle) == pytest.approx(exact, rel=4e-16)


@given(st.fractions(-30, 30, max_denominator=400), st.fractions(0, 2, max_denominator=400))
@example(Fraction(-19), Fraction(0))
def test_simplest_fraction_is_the_first_of_rising_denominators(low, width):
    high = low + width
    found = simplest_fraction(low, high)
    assert low <= found <= high
    for denominator in range(1, found.denominator):
        assert math.floor(high * denominator) < low * denominator
    inside = range(math.ceil(low * found.denominator), math.floor(high * found.denominator) + 1)
    assert abs(found.numerator) == min(map(abs, inside))
    with pytest.raises(ValueError, match='no number is between'):
        simplest_fraction(high + 1, low)


@settings(max_examples=40)
@given(st.fractions(-40, -1, max_denominator=99), st.fractions(0, 1, max_denominator=999))
def test_tooth_pairs_are_all_of_the_interval(low, width):
    high = min(low + width, Fraction(-1, 100))
    expected = [
        (ring, satellite)
        for ring in range(2, 61)
        for satellite in range(1, ring)
        if low <= Fraction(-satellite, ring - satellite) <= high
    ]
    assert list(tooth_pairs(low, high, 60)) == expected


def test_products_with_arrays_are_floats_and_lists_are_taken():
    ratio, angle = GearRatio(-19), np.array([0.5, 1.0])
    for product in (ratio * angle, angle * ratio, ratio.rotor_angle([0.5, 1.0])):
        assert product.dtype == np.float64
        assert product.tolist() == [-9.5, -19.0]
    assert (angle / ratio).tolist() == ratio.output_rate([0.5, 1.0]).tolist()
    state = rotor_state_for(ratio, [0.5, 1.0], [1.0, 2.0], [38.0, 19.0])
    np.testing.assert_allclose(state.position, [-9.5, -19.0], rtol=1e-15)
    assert (state.velocity.tolist(), state.effort.tolist()) == ([-19.0, -38.0], [-2.0, -1.0])
    assert isinstance(2 * ratio, Fraction)

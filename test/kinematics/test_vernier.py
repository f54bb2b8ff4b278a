"""The vernier of pin holes: counts by brute force, and the nearest setting truly nearest."""

import math
from fractions import Fraction
from itertools import pairwise, product

import mpmath
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from gear_kinematics.kinematics.vernier import (
    combinations,
    distinct_positions,
    nearest_setting,
    ring_body_positions,
    step,
)

SMALL = range(1, 13)


def turn_of(ring_teeth: int, tooth: int, ring_hole: int, chassis_hole: int) -> Fraction:
    """What a setting turns the ring gear's profile by, in whole turns, from first principles."""
    return (
        Fraction(tooth, ring_teeth)
        + Fraction(ring_hole, ring_teeth + 1)
        + Fraction(chassis_hole, ring_teeth + 2)
    ) % 1


def every_turn(ring_teeth: int) -> list[Fraction]:
    holes = (range(ring_teeth), range(ring_teeth + 1), range(ring_teeth + 2))
    return [turn_of(ring_teeth, *setting) for setting in product(*holes)]


def apart(angle: float, turn: Fraction) -> mpmath.mpf:
    """How far a setting is from an angle, rad, at 30 digits and the short way round."""
    with mpmath.workdps(30):
        whole = mpmath.mpf(angle) / (2 * mpmath.pi) - mpmath.mpf(turn.numerator) / turn.denominator
        return 2 * mpmath.pi * abs(whole - mpmath.nint(whole))


def assert_consistent(ring_teeth: int, setting) -> None:
    """The holes exist and give the turn that the setting claims."""
    assert 0 <= setting.tooth < ring_teeth
    assert 0 <= setting.ring_hole <= ring_teeth
    assert 0 <= setting.chassis_hole <= ring_teeth + 1
    holes = (setting.tooth, setting.ring_hole, setting.chassis_hole)
    assert setting.turn == turn_of(ring_teeth, *holes)
    assert setting.angle == pytest.approx(2.0 * math.pi * float(setting.turn), rel=4e-16)


def test_numbers_of_the_specification():
    assert combinations(80) == 531_360
    assert distinct_positions(80) == 265_680
    assert ring_body_positions(80) == 6_642
    seconds = math.degrees(step(80)) * 3600.0
    assert seconds == pytest.approx(4.878, abs=5e-4)
    assert seconds / 2.0 == pytest.approx(2.439, abs=5e-4)


@pytest.mark.parametrize('ring_teeth', SMALL)
def test_counts_are_what_counting_gives(ring_teeth):
    turns = every_turn(ring_teeth)
    positions = sorted(set(turns))
    assert combinations(ring_teeth) == len(turns)
    assert distinct_positions(ring_teeth) == len(positions)
    assert len(turns) == len(positions) * (2 if ring_teeth % 2 == 0 else 1)
    gaps = {after - before for before, after in pairwise([*positions, positions[0] + 1])}
    assert len(gaps) == 1
    assert step(ring_teeth) == pytest.approx(2.0 * math.pi * float(gaps.pop()), rel=1e-15)


@pytest.mark.parametrize('ring_teeth', SMALL)
def test_every_position_is_reached_from_its_own_angle(ring_teeth):
    """Also from angles by whole turns away, either way."""
    for turn in set(every_turn(ring_teeth)):
        for whole in (-2, -1, 0, 1, 3):
            setting = nearest_setting(ring_teeth, 2.0 * math.pi * (float(turn) + whole))
            assert_consistent(ring_teeth, setting)
            assert setting.turn == turn


@pytest.mark.parametrize('ring_teeth', SMALL)
def test_nearest_is_nearest_of_all(ring_teeth):
    """On both sides of every middle between two positions, the wrap-around included."""
    positions = sorted(set(every_turn(ring_teeth)))
    gap = step(ring_teeth)
    for n, turn in enumerate(positions):
        middle = 2.0 * math.pi * float(turn) + gap / 2.0
        below = nearest_setting(ring_teeth, middle - gap * 1e-6)
        above = nearest_setting(ring_teeth, middle + gap * 1e-6 - 2.0 * math.pi)
        assert below.turn == turn
        assert above.turn == positions[(n + 1) % len(positions)]
        assert_consistent(ring_teeth, below)
        assert_consistent(ring_teeth, above)


@pytest.mark.parametrize('ring_teeth', [1, 2, 3, 5, 6])
@given(st.floats(-30.0, 30.0))
def test_no_setting_is_nearer(ring_teeth, angle):
    setting = nearest_setting(ring_teeth, angle)
    nearest = min(apart(angle, turn) for turn in set(every_turn(ring_teeth)))
    assert apart(angle, setting.turn) <= nearest + 1e-14


@given(st.integers(1, 400), st.floats(-100.0, 100.0))
@example(80, 0.0)
@example(80, math.pi)
@example(80, -math.pi)
@example(80, -1e-9)
@example(80, 2.0 * math.pi - 1e-9)
def test_nearest_is_within_half_a_step(ring_teeth, angle):
    setting = nearest_setting(ring_teeth, angle)
    assert_consistent(ring_teeth, setting)
    assert 0 <= setting.turn < 1
    assert apart(angle, setting.turn) <= step(ring_teeth) / 2.0 + 1e-13


def test_half_steps_of_the_paper_are_enough_for_every_angle():
    """± 2.44 seconds of arc for 80 teeth, at a thousand angles over the turn."""
    for n in range(1000):
        angle = n * 0.0062831
        seconds = math.degrees(float(apart(angle, nearest_setting(80, angle).turn))) * 3600.0
        assert seconds <= 2.4391


@pytest.mark.parametrize(
    ('ring_teeth', 'angle'),
    [(0, 1.0), (-80, 1.0), (80, math.nan), (80, math.inf), (80, -math.inf)],
)
def test_what_has_no_setting_is_refused(ring_teeth, angle):
    with pytest.raises(ValueError, match=f'no pin setting for {ring_teeth} teeth at an angle of'):
        nearest_setting(ring_teeth, angle)

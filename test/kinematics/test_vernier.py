# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The vernier of pin holes: counts and nearest settings by brute force."""

import math
from collections import defaultdict
from fractions import Fraction
from itertools import pairwise, product

import mpmath
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from oracle import turn_of

from gear_kinematics.kinematics.vernier import (
    angle_between,
    choices,
    combinations,
    distinct_positions,
    pin_setting,
    step,
)

SMALL = range(1, 13)


def every_setting(ring_teeth: int) -> list[tuple[int, int, int]]:
    return list(product(range(ring_teeth), range(ring_teeth + 1), range(ring_teeth + 2)))


def every_turn(ring_teeth: int) -> list[Fraction]:
    return [turn_of(ring_teeth, *setting) for setting in every_setting(ring_teeth)]


def fraction(value: Fraction) -> mpmath.mpf:
    return mpmath.mpf(value.numerator) / value.denominator


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
    seconds = math.degrees(step(80)) * 3600.0
    assert seconds == pytest.approx(4.878, abs=5e-4)
    assert seconds / 2.0 == pytest.approx(2.439, abs=5e-4)


@pytest.mark.parametrize('ring_teeth', SMALL)
def test_counts_agree_with_enumeration(ring_teeth):
    turns = every_turn(ring_teeth)
    positions = sorted(set(turns))
    assert combinations(ring_teeth) == len(turns)
    assert distinct_positions(ring_teeth) == len(positions)
    assert len(turns) == len(positions) * (2 if ring_teeth % 2 == 0 else 1)
    gaps = {after - before for before, after in pairwise([*positions, positions[0] + 1])}
    assert len(gaps) == 1
    assert step(ring_teeth) == pytest.approx(2.0 * math.pi * float(gaps.pop()), rel=1e-15)


@pytest.mark.slow
@pytest.mark.parametrize('ring_teeth', SMALL)
def test_nearest_is_nearest_of_all(ring_teeth):
    """On both sides of each midpoint between positions, including the wrap-around."""
    positions = sorted(set(every_turn(ring_teeth)))
    gap = step(ring_teeth)
    for n, turn in enumerate(positions):
        middle = 2.0 * math.pi * float(turn) + gap / 2.0
        for angle, expected in (
            (middle - gap * 1e-6, turn),
            (middle + gap * 1e-6 - 2.0 * math.pi, positions[(n + 1) % len(positions)]),
        ):
            [nearest] = choices(ring_teeth, angle)
            for setting in nearest.settings:
                assert setting.turn == expected
                assert_consistent(ring_teeth, setting)


@pytest.mark.parametrize(
    ('function', 'arguments', 'cause'),
    [
        (choices, (0, 1.0), 'at least 1 tooth, not 0'),
        (choices, (80, math.nan), 'finite, not nan rad'),
        (choices, (80, -math.inf), 'finite, not -inf rad'),
        (pin_setting, (80, 80, 0, 0), 'tooth 80 is not one of 0 to 79'),
        (pin_setting, (80, 0, 81, 0), 'ring hole 81 is not one of 0 to 80'),
        (pin_setting, (80, 0, 0, 82), 'chassis hole 82 is not one of 0 to 81'),
        (pin_setting, (80, 0, -1, 0), 'ring hole -1 is not one of 0 to 80'),
    ],
)
def test_impossible_arguments_are_refused(function, arguments, cause):
    with pytest.raises(ValueError, match=cause):
        function(*arguments)


@pytest.mark.parametrize('ring_teeth', SMALL)
def test_settings_of_a_position_are_complete(ring_teeth):
    """The first turns the body least, from any setting of the ring."""
    same = defaultdict(set)
    for holes in every_setting(ring_teeth):
        same[turn_of(ring_teeth, *holes)].add(holes)
    start = pin_setting(ring_teeth, 0, ring_teeth // 3, ring_teeth // 2)
    for turn, expected in same.items():
        angle = 2.0 * math.pi * float(turn - start.turn)
        [choice] = choices(ring_teeth, angle, start)
        found = [(s.tooth, s.ring_hole, s.chassis_hole) for s in choice.settings]
        assert len(found) == len(expected)
        assert set(found) == expected
        assert {s.turn for s in choice.settings} == {turn}
        bodies = [
            s.turn - Fraction(s.tooth, ring_teeth) - start.body_turn for s in choice.settings
        ]
        assert [s.body_turn for s in choice.settings] == [
            (body + start.body_turn) % 1 for body in bodies
        ]
        ways = [abs(body - round(body)) for body in bodies]
        assert ways == sorted(ways)


@pytest.mark.slow
@given(
    ring_teeth=st.integers(1, 9),
    angle=st.floats(-7.0, 7.0),
    neighbours=st.integers(0, 12),
    data=st.data(),
)
def test_neighbours_are_the_next_positions_either_way(ring_teeth, angle, neighbours, data):
    """As in the sorted list of all positions, cyclically."""
    start = pin_setting(ring_teeth, *data.draw(st.sampled_from(every_setting(ring_teeth))))
    positions = sorted({turn_of(ring_teeth, *holes) for holes in every_setting(ring_teeth)})
    found = choices(ring_teeth, angle, start, neighbours)
    assert [choice.steps for choice in found] == list(range(-neighbours, neighbours + 1))
    nearest = positions.index(found[neighbours].settings[0].turn)
    for choice in found:
        expected = positions[(nearest + choice.steps) % len(positions)]
        assert {setting.turn for setting in choice.settings} == {expected}
        assert choice.ring_turn == pytest.approx(angle + choice.error, abs=1e-14)
        turned = mpmath.mpf(angle) + choice.error - 2 * mpmath.pi * fraction(expected - start.turn)
        assert abs(mpmath.sin(turned / 2)) < 1e-14
    assert abs(found[neighbours].error) <= step(ring_teeth) / 2.0 + 1e-14


@given(st.integers(1, 100_000), st.floats(-7.0, 7.0))
@example(80, math.pi)
@example(80, 2.0 * math.pi - 1e-9)
def test_errors_keep_their_last_bits(ring_teeth, angle):
    [choice] = choices(ring_teeth, angle)  # by enumeration, 100 000 teeth would take days
    assert_consistent(ring_teeth, choice.settings[0])
    with mpmath.workdps(50):
        turn = choice.settings[0].turn
        exact = 2 * mpmath.pi * fraction(turn) - mpmath.mpf(angle)
        exact -= 2 * mpmath.pi * mpmath.nint(exact / (2 * mpmath.pi))
        assert abs(choice.error - exact) <= 4e-16 * abs(exact) + mpmath.mpf('1e-30')
    assert abs(choice.error) <= step(ring_teeth) / 2.0


@pytest.mark.parametrize(
    ('start', 'end', 'expected'),
    [('0', '1/4', 90), ('1/4', '0', -90), ('9/10', '1/10', 72), ('0', '1/2', -180), ('1', '2', 0)],
)
def test_angle_between_is_the_shorter_one(start, end, expected):
    angle = angle_between(Fraction(start), Fraction(end))
    assert math.degrees(angle) == pytest.approx(expected, abs=1e-13)

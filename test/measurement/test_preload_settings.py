# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Settings of the preload in the names of recordings."""

import math
from fractions import Fraction

import pytest

from gear_kinematics.kinematics import GearRatio
from gear_kinematics.measurement.names import settings_of

PINS = ['pins_0_0_0.csv', 'pins_0_78_1.csv', 'pins_79_5_81.csv']


@pytest.mark.parametrize(
    ('names', 'pattern', 'settings'),
    [
        (['gear_preload_1_position_1.csv', 'gear_preload_2.5_x.csv'], '', [1.0, 2.5]),
        (['0712_1407_conic_1pre1.csv', '0712_1452_conic_2pre1.csv'], r'_(\d)pre', [1.0, 2.0]),
        (['a at 3.csv', 'a at 1e1.csv'], r'at (\S+)\.csv', [3.0, 10.0]),
    ],
)
def test_plain_numbers(actuator, names, pattern, settings):
    found, scale = settings_of(names, pattern, None, actuator)
    assert found == settings
    assert (scale.unit, scale.size, scale.play) == ('', 1.0, None)


def test_turns_in_a_unit_close_the_play_by_the_teeth(actuator):
    found, scale = settings_of(['g_turn_0.csv', 'g_turn_0.15.csv'], '', 'deg', actuator)
    assert found == pytest.approx([0.0, 0.15 * math.pi / 180.0])
    assert scale.play == pytest.approx(80 / 76)


@pytest.mark.parametrize('pattern', ['', r'(\d+)_(\d+)_(\d+)'])
def test_pins_turn_the_ring_gear(actuator, pattern):
    found, scale = settings_of(PINS, pattern, None, actuator)
    # The turns of tooth, ring hole and chassis hole, within half a turn of zero.
    turns = [Fraction(t, 80) + Fraction(r, 81) + Fraction(c, 82)
             for t, r, c in ((0, 0, 0), (0, 78, 1), (79, 5, 81))]  # fmt: skip
    expected = [abs((turn + Fraction(1, 2)) % 1 - Fraction(1, 2)) for turn in turns]
    assert found == pytest.approx([2.0 * math.pi * float(turn) for turn in expected])
    assert scale.unit == 'deg'


@pytest.mark.parametrize(
    ('names', 'pattern', 'complaint'),
    [
        (['preload_1.csv', 'other.csv'], '', 'no setting in the name other.csv'),
        (['a1.csv'], r'a\d', 'one group in parentheses, or three for pins, not 0'),
        (['a1.csv'], '(', r'preloads \(: '),
        (['abc.csv'], '(b)', "'b' is no setting"),
        (['pins_80_0_0.csv'], '', '80'),
    ],
)
def test_settings_that_cannot_be_read_are_refused(actuator, names, pattern, complaint):
    with pytest.raises(ValueError, match=complaint):
        settings_of(names, pattern, None, actuator)


def test_turns_need_a_gear_with_teeth():
    with pytest.raises(ValueError, match='turns of a ring gear need its teeth'):
        settings_of(['turn_1.csv'], '', 'deg', GearRatio.parse('-19'))

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Up to which preload the figures fall, on simulated gears and measured figures."""

import math

import numpy as np
import pytest
from advising import coverage, readings
from braced_gears import BracedGear
from gear_recordings import quantised, ramps

from gear_kinematics.kinematics import GearRatio
from gear_kinematics.measurement.figures import gear_figures, settings_for
from gear_kinematics.measurement.loops import find_ramps
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.names import Scale
from gear_kinematics.measurement.preload.advice import Reading, advise
from gear_kinematics.measurement.preload.section import over_preload

GEAR = BracedGear()
NUMBERS = Scale('', 1.0, None)
ARC_MINUTE = math.radians(1.0 / 60.0)
RATIO = GearRatio.parse('-19')
BASE = ((72, 117, 137), (44, 52, 71), (27, 43, 44), (16, 20, 30), (16, 18, 23))
"""Lost motion without friction of a cycloidal actuator, ′, at five settings and three positions of
the output."""
CONIC = (111, 40, 39, 43, 44)
"""Hysteresis with conic disks at five settings, ′."""


def measured(setting: float, angle: float) -> Reading:
    """Of an angle in ′."""
    return Reading(setting, angle * ARC_MINUTE, 1.5, 1.5, (1.0 / 300.0, 1.0 / 300.0))


def recorded(gear: BracedGear, setting: float, amplitude: float = 6.0) -> LostMotion:
    """Ramps of a gear, read with an encoder."""
    torque = ramps(*[(amplitude, 60)] * 3, *[(30.0, 90)] * 2)
    found = find_ramps(torque, quantised(gear.angles(torque, setting), 1e-5))
    figures = gear_figures(found, settings_for(found, 1e-5))
    return LostMotion(f'at {setting:g}', None, RATIO, figures)


@pytest.mark.parametrize('play', [GEAR.closing, None])
@pytest.mark.parametrize('load', [1.0, 2.0, 5.0])
def test_advice_without_scatter_is_the_simulated_gear(play, load):
    random = np.random.default_rng(7)
    found = readings(GEAR, (0.0, 0.8, 1.6, 4.0, 5.0, 6.0), 0.0, random)
    advice = advise(found, play, load)
    # Hysteresis grows a little with friction after the fall, which the model does not know.
    assert advice.least.value == pytest.approx(GEAR.least(load), abs=0.15)
    more = GEAR.drag(GEAR.least(load)) - GEAR.friction
    assert advice.added_friction.value == pytest.approx(more, rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize('name', ['seven, turns', 'five twice, numbers'])
def test_intervals_hold(name):
    found = coverage(name, 300, 2.0)
    assert found['least'] >= 0.93
    assert found['told'] > 0.95


def test_measured_lost_motion_falls_up_to_the_fourth_setting():
    found = [measured(k, v) for k, row in enumerate(BASE, 1) for v in row]
    advice = advise(found, None, None)
    assert advice.falling
    assert 3.0 < advice.end.low < advice.end.value
    assert advice.end.value == pytest.approx(4.0, abs=0.7)


def test_a_fall_that_one_recording_shows_has_no_end_beyond_the_next():
    advice = advise([measured(k, v) for k, v in enumerate(CONIC, 1)], None, None)
    assert advice.falling
    assert advice.end.low < 1.1
    assert 2.0 <= advice.end.high < 3.0


@pytest.mark.parametrize('place', range(5))
def test_one_recording_shows_no_fall_up_to_its_setting(place):
    """Neither a high nor a low one among equal recordings; at the least setting it may be one."""
    for factor in (0.5, 2.0):
        found = [measured(k, 40.0 * (1.02 if k % 2 else 0.98)) for k in range(5) for _ in range(2)]
        found[2 * place] = measured(place, 40.0 * factor)
        advice = advise(found, None, None)
        assert not advice.falling or advice.end.value < 2.0


@pytest.mark.parametrize(
    ('settings', 'scale', 'load', 'parts'),
    [
        ((0.0, 1.0, 2.0, 4.0, 5.0, 6.0), NUMBERS, 2.0,
         ('Hysteresis falls from ', '′ up to the setting 2.7', 'and no further',
          'both branches stay in mesh under 2 N·m from 3.5', 'more friction')),
        ((0.0, 0.5, 1.0, 1.5), NUMBERS, 2.0,
         ('Hysteresis still falls at the greatest setting, 1.5: record greater', 'is not known')),
        ((0.0, 4.0, 4.5, 5.0, 5.5, 6.0), NUMBERS, 2.0,
         ('up to a setting between 0', 'under 2 N·m is not known')),
        ((5.0, 6.0, 7.0, 8.0), NUMBERS, None, ('Hysteresis does not clearly fall',)),
    ],
)  # fmt: skip
def test_the_sentence_says_up_to_which_setting_the_figures_fall(settings, scale, load, parts):
    gear = BracedGear(rubbing=0.2)
    found = over_preload([recorded(gear, s) for s in settings], settings, scale, load)
    for part in parts:
        assert part in found.sentence
    assert found.section.remarks[0] == f'{found.sentence}.'
    assert len(found.section.figure.panels) == 2


def test_recordings_of_other_ramps_do_not_count():
    reports = [recorded(GEAR, 0.0), recorded(GEAR, 2.0), recorded(GEAR, 4.0, 15.0)]
    with pytest.raises(ValueError, match='of about one amplitude at 3 settings, not at'):
        over_preload(
            [*reports, LostMotion('none', None, RATIO)], (0.0, 2.0, 4.0, 5.0), NUMBERS, None
        )

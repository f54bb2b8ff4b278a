# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The backlash that torque ramps leave room for: of simulated gears that are known."""

import math

import numpy as np
import pytest
from gear_recordings import Gear, creep, ramps
from simulated_ramps import SCENARIOS, Scenario, judge, measured

from gear_kinematics.measurement.backlash import Backlash, Cause, reconciled
from gear_kinematics.measurement.figures import gear_figures
from gear_kinematics.measurement.loops import find_ramps

ARC_MINUTE = math.radians(1.0 / 60.0)
TEN = 10.0 * ARC_MINUTE
NAMED = {scenario.name: scenario for scenario in SCENARIOS}


@pytest.mark.slow
@pytest.mark.parametrize(
    'name',
    [
        'play, linear spring',
        'no play, linear spring',
        'play, softening spring',
        'no play, softening spring',
        'play, hardening spring, large loops only',
        'no play, hardening spring',
        'play, Hertzian spring',
        'no play, Hertzian spring',
        'creep of 10 %',
    ],
)
def test_interval_contains_the_play(name):
    """20 gears that all differ; benchmark/lost_motion.py judges 200."""
    found = judge(NAMED[name], 20)
    # If 95 % hold, fewer than 17 of 20 do once in 60 times.
    assert found.backlash >= 17 / 20
    assert found.hysteresis >= 17 / 20
    if not NAMED[name].play:
        assert found.above_zero == 0.0


def test_interval_contains_the_play_of_an_encoder_with_few_steps():
    """A play of 1.3 steps, and a spring that yields by less than one to the small ramps."""
    step, gear = 2.0 * math.pi / 4096.0, Gear(play=0.002, stiffness=3000.0, friction=1.0)
    torque = ramps(*[(3.0, 200)] * 5, *[(40.0, 400)] * 3)
    angle = (np.round(creep(gear, torque) / step + 0.5)) * step
    torque = torque + 0.05 * np.random.default_rng(1).standard_normal(len(torque))
    backlash = gear_figures(find_ramps(torque, angle, step), 40.0).backlash
    assert backlash.low <= gear.play <= backlash.high


@pytest.mark.slow
def test_interval_is_narrow_where_the_spring_is_straight():
    """A play of 10′ and a friction of half of the ramps: no wider than 3′."""
    found = judge(Scenario('half of it friction', play=TEN, friction=2.0), 20, alike=True)
    assert found.width < 1.5 * ARC_MINUTE
    assert found.widest < 3.0 * ARC_MINUTE
    assert found.above_zero == 1.0


def test_a_clear_dead_band_has_a_value():
    torque = ramps(*[(4.0, 200)] * 5)
    backlash = measured(torque, creep(Gear(TEN, 300.0, 1.0), torque)).backlash
    assert backlash.cause == Cause.NONE
    assert backlash.value.value == pytest.approx(TEN, abs=0.2 * ARC_MINUTE)
    assert backlash.low < TEN < backlash.high
    assert backlash.value.uncertainty == pytest.approx(0.5 * (backlash.high - backlash.low))


def test_it_is_never_wider_than_the_hysteresis():
    """A middle that yields over 200′ to friction of the same size, as of a worn gear."""
    torque = ramps(*[(4.0, 200)] * 5)
    angle = 200.0 * ARC_MINUTE * np.clip(torque, -0.5, 0.5) + torque / 600.0
    angle[1::2] += 3.0 * ARC_MINUTE  # rests anywhere
    figures = measured(torque, angle)
    width = figures.hysteresis
    assert figures.backlash.high <= width.value + width.uncertainty + 1e-12


def test_friction_that_takes_up_the_torque_leaves_everything_open():
    torque = ramps(*[(1.1, 200)] * 5)
    backlash = measured(torque, creep(Gear(0.0, 300.0, 1.0), torque)).backlash
    assert backlash == Backlash(0.0, None, Cause.FRICTION)
    assert backlash.value is None


@pytest.mark.parametrize(
    ('found', 'expected'),
    [
        ([Backlash(1.0, 4.0, Cause.NONE), Backlash(0.0, 9.0, Cause.BENT)], (1.0, 4.0)),
        ([Backlash(1.0, 4.0, Cause.NONE), Backlash(2.0, 9.0, Cause.BENT)], (2.0, 4.0)),
        ([Backlash(0.0, 4.0, Cause.SOFT), None], (0.0, 4.0)),
        ([Backlash(0.0, 4.0, Cause.SOFT), Backlash(3.0, 3.5, Cause.NONE)], (0.0, 3.5)),
        ([Backlash(1.0, 4.0, Cause.NONE), Backlash(0.0, 3.0, Cause.SOFT)], (1.0, 3.0)),
        ([Backlash(1.0, 4.0, Cause.NONE), Backlash(5.0, 9.0, Cause.BENT)], (1.0, 9.0)),
        ([None], (0.0, None)),
    ],
)
def test_ramps_of_all_amplitudes_have_one_backlash(found, expected):
    one = reconciled(found)
    assert (one.low, one.high) == expected
    contradict = expected == (1.0, 9.0)
    assert (one.cause == Cause.CONTRADICTION) == contradict
    assert not (contradict and one.value)

"""The backlash that torque ramps leave room for: of simulated gears that are known."""

import math

import numpy as np
import pytest
from gear_recordings import Gear, creep, ramps
from judging_ramps import judge, measured
from simulated_ramps import (
    LARGE_ONLY,
    SCENARIOS,
    STEP,
    Scenario,
    hardening,
    hertzian,
    simulate,
    softening,
)

from gear_kinematics.measurement.loops import find_ramps
from gear_kinematics.measurement.lost_motion import time_remarks
from gear_kinematics.measurement.middle_line import Backlash, Cause, reconciled

ARC_MINUTE = math.radians(1.0 / 60.0)
TEN = 10.0 * ARC_MINUTE
GEARS = (
    Scenario('play, half of it friction', play=TEN, friction=2.0),
    Scenario('no play'),
    Scenario('soft, play', play=TEN, spring=softening),
    Scenario('soft', spring=softening),
    Scenario('hard, play', play=TEN, spring=hardening),
    Scenario('hard', spring=hardening),
    Scenario('Hertzian, play', play=TEN, spring=hertzian),
    Scenario('Hertzian', spring=hertzian),
    Scenario('creeping, play', play=TEN, creeps=((0.1, 5.0),)),
    Scenario('creeping', creeps=((0.1, 5.0),)),
    Scenario('creeping and hard', spring=hardening, creeps=((0.1, 5.0),)),
    Scenario('large loops alone, hard', spring=hardening, loops=LARGE_ONLY),
)


@pytest.mark.slow
@pytest.mark.parametrize('scenario', GEARS, ids=lambda scenario: scenario.name)
def test_interval_contains_the_play(scenario):
    """20 gears that all differ; benchmark/lost_motion.py judges 200."""
    found = judge(scenario, 20)
    # If 95 % hold, fewer than 17 of 20 do once in 60 times.
    assert found.backlash >= 17 / 20
    assert found.hysteresis >= 17 / 20
    if not scenario.play:
        assert found.above_zero == 0.0


@pytest.mark.slow
def test_interval_is_narrow_where_the_spring_is_straight():
    """A play of 10′ and a friction of half of the ramps: no wider than 3′."""
    found = judge(GEARS[0], 20, alike=True)
    assert found.width < 1.5 * ARC_MINUTE
    assert found.widest < 3.0 * ARC_MINUTE
    assert found.above_zero == 1.0


def test_a_clear_dead_band_has_a_value():
    torque = ramps(*[(4.0, 200)] * 5)
    angle = creep(Gear(play=TEN, stiffness=300.0, friction=1.0), torque)
    backlash = measured(torque, angle, np.arange(len(torque)) / 100.0).backlash
    assert backlash.cause == Cause.NONE
    assert backlash.value.value == pytest.approx(TEN, abs=0.2 * ARC_MINUTE)
    assert backlash.low < TEN < backlash.high
    assert backlash.value.uncertainty == pytest.approx(0.5 * (backlash.high - backlash.low))


def test_it_is_never_wider_than_the_hysteresis():
    """A middle that yields over 200′ to friction of the same size, as of a worn gear."""
    torque = ramps(*[(4.0, 200)] * 5)
    load = np.clip(torque, -0.5, 0.5)
    angle = 200.0 * ARC_MINUTE * load + torque / 600.0
    angle[1::2] += 3.0 * ARC_MINUTE  # rests anywhere
    figures = measured(torque, angle, np.arange(len(torque)) / 100.0)
    width = figures.hysteresis
    assert figures.backlash.high <= width.value + width.uncertainty + 1e-12


def test_friction_that_takes_up_the_torque_leaves_everything_open():
    torque = ramps(*[(1.1, 200)] * 5)
    angle = creep(Gear(play=0.0, stiffness=300.0, friction=1.0), torque)
    backlash = measured(torque, angle, np.arange(len(torque)) / 100.0).backlash
    assert backlash == Backlash(0.0, None, Cause.FRICTION)
    assert backlash.value is None


@pytest.mark.parametrize(
    ('found', 'expected'),
    [
        ([Backlash(1.0, 4.0, Cause.NONE), Backlash(0.0, 9.0, Cause.BENT)], (1.0, 4.0)),
        ([Backlash(1.0, 4.0, Cause.NONE), Backlash(2.0, 9.0, Cause.BENT)], (2.0, 4.0)),
        ([Backlash(0.0, 4.0, Cause.SOFT), None], (0.0, 4.0)),
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


@pytest.mark.slow
@pytest.mark.parametrize(
    ('name', 'said'),
    [
        ('play, linear spring', ''),
        ('creep of 10 %', 'the angle goes on by'),
        ('encoder 20 ms late', 'the angle goes on by'),
        ('thermal sine', ''),
    ],
)
def test_what_time_does_is_one_remark(name, said):
    scenario = next(one for one in SCENARIOS if one.name == name)
    recorded = simulate(scenario, np.random.default_rng(3))
    found = find_ramps(recorded.torque, recorded.angle, recorded.time)
    friction = measured(recorded.torque, recorded.angle, recorded.time).friction
    remarks = list(time_remarks(found, friction, STEP))
    assert [said in remark for remark in remarks if 'drifts' not in remark] == [True] * bool(said)


def test_an_even_drift_is_told_with_its_size():
    torque = ramps(*[(4.0, 200)] * 6)
    time = np.arange(len(torque)) / 100.0
    angle = creep(Gear(play=0.01, stiffness=300.0, friction=1.0), torque) + 1e-4 * time
    (remark,) = time_remarks(find_ramps(torque, angle, time), None, 0.0)
    moved, seconds = (float(remark.split()[k]) for k in (4, 9))
    assert math.radians(moved / 60.0) / seconds == pytest.approx(1e-4, rel=0.02)

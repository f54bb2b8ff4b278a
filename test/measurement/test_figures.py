# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Figures of hysteresis curves: of simulated gears that are known, and of a measured actuator."""

import csv
import math
from itertools import count, islice, product

import numpy as np
import pytest
from gear_recordings import Gear, creep, ramps
from simulated_encoders import stepped

from gear_kinematics.measurement.figures import GearFigures, gear_figures
from gear_kinematics.measurement.loops import RampError, find_ramps

RATED = 40.0
STEP = 2.0 * math.pi / 65536.0
SMALL, LARGE = 4.0, 40.0
TORQUE = ramps(*[(SMALL, 200)] * 5, *[(LARGE, 400)] * 3)
GEARS = {
    'backlash': Gear(play=0.02, stiffness=300.0, friction=1.0),
    'soft': Gear(play=0.005, stiffness=150.0, friction=0.5),
    'preloaded': Gear(play=0.0, stiffness=600.0, friction=1.6),
    # Small ramps begin to move it back just at zero torque, where noise rounds the corner.
    'corner': Gear(play=0.0, stiffness=300.0, friction=2.0),
}
NOISES = (0.0, 0.02, 0.1, 0.3)


def truth(gear: Gear) -> dict[str, float]:
    """Expected figures, by the definitions."""

    def angle(load: float) -> float:
        return load / gear.stiffness + math.copysign(0.5 * gear.play, load)

    def middle(torque: float) -> float:
        return 0.5 * (angle(torque - gear.friction) + angle(torque + gear.friction))

    at = 0.03 * RATED
    hysteresis, lost_motion = (
        angle(gear.friction) - angle(-gear.friction),
        middle(at) - middle(-at),
    )
    return gear._asdict() | {'hysteresis': hysteresis, 'lost_motion': lost_motion}


def measured(torque, angle, step=STEP, rated=RATED) -> GearFigures:
    return gear_figures(find_ramps(torque, angle, step), rated)


def estimates(found: GearFigures) -> dict:
    names = 'hysteresis', 'friction', 'lost_motion'
    figures = {name: getattr(found, name) for name in names}
    return figures | {'stiffness': found.stiffness[-1].slope}


@pytest.fixture(scope='module')
def angles() -> dict[str, np.ndarray]:
    return {name: creep(gear, TORQUE) for name, gear in GEARS.items()}


def recorded(angle, noise: float, seed: int):
    """Add noise to the torque and quantise the angle, from a zero of the encoder that differs."""
    generator = np.random.default_rng(seed)
    torque = TORQUE + noise * generator.standard_normal(len(TORQUE))
    return torque, stepped(angle + generator.uniform(0.0, STEP), STEP)


@pytest.mark.parametrize('name', GEARS)
def test_the_middle_line_is_the_spring(angles, name):
    """The middle line of the largest ramps, with the friction beside it."""
    gear, noisy = GEARS[name], recorded(angles[name], 0.02, seed=1)
    line = measured(*noisy).middle_line
    assert np.ptp(line.load) > 1.95 * (LARGE - gear.friction)
    # At its ends, noise decides which half of a loop turned back first.
    angle, load, friction = (values[2:-2] for values in (line.angle, line.load, line.friction))
    assert friction == pytest.approx(gear.friction, abs=0.15)
    left, right = (angle[side] - load[side] / gear.stiffness for side in (load < -1.0, load > 1.0))
    for side in (left, right):
        assert side == pytest.approx(side.mean(), abs=2e-4)
    assert right.mean() - left.mean() == pytest.approx(gear.play, abs=2e-4)
    # There is no load at 0 rad.
    assert left.mean() - 1e-4 <= 0.0 <= right.mean() + 1e-4
    assert line.load[line.angle == 0.0] == [0.0]


@pytest.mark.slow
@pytest.mark.parametrize('name', GEARS)
def test_figures_of_an_ideal_recording_are_those_of_the_gear(angles, name):
    expected = truth(GEARS[name])
    found = measured(TORQUE, angles[name], step=0.0)
    backlash = found.backlash
    assert backlash.low - 1e-5 <= expected['play'] <= backlash.high + 1e-5
    assert backlash.high - backlash.low < 1e-3
    for figure, estimate in estimates(found).items():
        # The simulation moves in steps of 2 µrad, and the torque in steps of 20 and 100 mN·m.
        tolerance = {'friction': 0.02, 'stiffness': 0.1}.get(figure, 2e-5)
        assert estimate.value == pytest.approx(expected[figure], abs=tolerance), figure


@pytest.mark.slow
def test_stated_uncertainties_hold_over_a_grid_of_noise(angles):
    """Intervals contain the true value as often as stated, and are no wider than that needs."""
    relative, widths = {}, []  # errors in intervals, by figure
    seeds = count()  # with the same noise, what holds for one gear would hold for all
    for (name, gear), noise in product(GEARS.items(), NOISES):
        expected = truth(gear)
        for seed in islice(seeds, 4):
            found = estimates(measured(*recorded(angles[name], noise, seed)))
            widths.append(found['hysteresis'].uncertainty)
            for figure, estimate in found.items():
                error = (estimate.value - expected[figure]) / estimate.uncertainty
                relative.setdefault(figure, []).append((noise, error))
    assert np.median(widths) < 4e-4
    for figure, errors in relative.items():
        assert len(errors) == 64
        # Of 64 intervals of 95 %, fewer than 55 hold the truth once in 1000 times.
        assert sum(abs(error) <= 1.0 for _, error in errors) >= 55, figure
        # Where noise dominates, an interval is a few times the error, not many times.
        noisy = [error for noise, error in errors if noise == NOISES[-1]]
        assert np.sqrt(np.mean(np.square(noisy))) > 0.1, figure


@pytest.mark.slow
def test_many_repeats_do_not_hide_that_noise_rounds_the_curve():
    """The gear goes through its play at a torque of 1 N·m; lost motion is read at 1.2 N·m."""
    torque = ramps(*[(LARGE, 400)] * 10)
    angle = creep(GEARS['backlash'], torque)
    expected = truth(GEARS['backlash'])['lost_motion']
    for seed in range(8):
        noisy = torque + 0.1 * np.random.default_rng(seed).standard_normal(len(torque))
        found = measured(noisy, angle, step=0.0)
        assert abs(found.lost_motion.value - expected) <= found.lost_motion.uncertainty


def test_ranges_of_stiffness_have_the_mean_of_both_signs():
    # Softer for negative torque, and harder from 20 N·m on.
    torque = ramps((40.0, 800), (40.0, 800), (40.0, 800))
    load = np.abs(torque)
    angle = np.where(load < 20.0, load / 200.0, 20.0 / 200.0 + (load - 20.0) / 500.0)
    angle = np.where(torque < 0.0, -2.0 * angle, angle)
    found = measured(torque, angle, step=0.0)
    ranges = [(round(s.low, 3), round(s.high, 3)) for s in found.stiffness]
    assert ranges == [(0.0, 6.0), (6.0, 20.0), (20.0, 40.0)]
    for stiffness, expected in zip(found.stiffness, (200.0, 200.0, 500.0), strict=True):
        # The mean of both compliances.
        assert stiffness.slope.value == pytest.approx(expected / 1.5, rel=1e-3)


@pytest.mark.parametrize('share', [0.2, 0.5, 0.7, 0.95])
def test_figures_between_the_steps_of_a_staircase_are_within_their_uncertainty(share):
    """Play is crossed at a share of a step of 2.5 N·m."""
    gear = GEARS['backlash']._replace(friction=2.5 * share)
    steps = np.repeat(np.round(ramps(*[(LARGE, 16)] * 5) / 2.5) * 2.5, 8)
    found = measured(steps, creep(gear, steps), step=0.0)
    lost = found.lost_motion
    assert abs(lost.value - truth(gear)['lost_motion']) <= lost.uncertainty < lost.value
    torque = np.linspace(0.0, 6.0, 10_000)
    load = torque - gear.friction
    angle = load / gear.stiffness + 0.5 * gear.play * np.sign(load)
    expected = 1.0 / np.polynomial.polynomial.polyfit(torque, angle, 1)[1]
    lowest = found.stiffness[0].slope
    assert abs(lowest.value - expected) <= lowest.uncertainty < 0.5 * expected


def test_scatter_of_either_sign_of_torque_is_not_hidden_by_the_other():
    """The compliances of both signs change from loop to loop, but their means do not."""
    torque = ramps(*[(40.0, 800)] * 4)
    change = np.repeat([0.01, -0.01, 0.01, -0.01], len(torque) // 4 + 1)[: len(torque)]
    found = measured(torque, torque / 200.0 * (1.0 + change * np.sign(torque)), step=0.0)
    scatter = 0.01 / math.sqrt(2.0)  # of a mean compliance with independent signs
    for stiffness in found.stiffness:
        assert stiffness.slope.value == pytest.approx(200.0, rel=1e-3)
        assert stiffness.slope.uncertainty / 200.0 > scatter / math.sqrt(4.0)


def test_the_ends_of_a_noisy_staircase_are_no_straight_ramp():
    steps = np.repeat(np.round(ramps(*[(LARGE, 80)] * 5) / 8.0) * 8.0, 8)
    noisy = steps + 0.02 * np.random.default_rng(1).standard_normal(len(steps))
    found = measured(noisy, steps / 2500.0, step=0.0)
    for stiffness in (found.overall, found.stiffness[-1].slope):
        assert stiffness.value == pytest.approx(2500.0, rel=1e-3)


@pytest.mark.parametrize('step', [0.0, math.radians(0.2)])
def test_the_overall_stiffness_is_within_its_uncertainty(step):
    """The peak of a hardening spring lies between samples, or between steps of the encoder."""
    torque = ramps(*[(LARGE, 30)] * 3)
    angle = np.sign(torque) * 0.02 * np.sqrt(np.abs(torque) / LARGE)
    torque = torque + 0.05 * np.random.default_rng(1).standard_normal(len(torque))
    dense = np.linspace(0.0, LARGE, 10_000)
    curve = 0.02 * np.sqrt(dense / LARGE)
    expected = 1.0 / np.polynomial.polynomial.polyfit(dense, curve, 1)[1]
    found = measured(torque, stepped(angle, step) if step else angle, step).overall
    assert abs(found.value - expected) <= found.uncertainty < 0.4 * expected


@pytest.mark.parametrize('levels', [1, 1.3])
@pytest.mark.parametrize('rows', [1, 4])
def test_the_overall_stiffness_is_known_by_one_weight_on_each_side(levels, rows):
    torque = np.repeat(np.round(ramps(*[(LARGE, 16)] * 5) * levels / LARGE) * LARGE / levels, rows)
    assert measured(torque, torque / 2500.0, step=0.0).overall.value == pytest.approx(2500.0)


def test_ranges_that_the_ramps_do_not_reach_are_left_out():
    torque = ramps(*[(6.5, 200)] * 3)
    found = measured(torque, creep(GEARS['soft'], torque), step=0.0)
    assert [(s.low, round(s.high, 2)) for s in found.stiffness] == [(0.0, 6.0)]
    torque = ramps((1.0, 200), (1.0, 200))
    found = measured(torque, creep(Gear(0.01, 300.0, 0.2), torque), step=0.0)
    assert found.lost_motion is None
    assert found.hysteresis.value == pytest.approx(0.01 + 0.4 / 300.0, abs=1e-5)


def test_a_range_that_friction_holds_has_no_stiffness():
    """From the peak at -4 N·m on, a friction of ±2.5 N·m holds it up to +1 N·m."""
    torque = ramps(*[(4.0, 200)] * 3)
    found = measured(torque, creep(Gear(0.02, 300.0, 2.5), torque), step=0.0, rated=4.0)
    assert [round(s.low, 3) for s in found.stiffness] == [0.6, 2.0]


@pytest.mark.parametrize('offset', [0.0, 0.1, -1e3])
def test_angle_that_does_not_follow_the_torque_is_refused(offset):
    torque = ramps(*[(SMALL, 200)] * 3)
    for angle in (0.0 * torque, -torque / 300.0):
        with pytest.raises(RampError, match='does not grow with the torque'):
            measured(torque, angle + offset, step=0.0, rated=SMALL)


# The measured actuator


def columns(path) -> dict[str, np.ndarray]:
    names, *rows = csv.reader(path.read_text('utf-8').splitlines())
    return dict(zip(names, np.array(rows, float).T, strict=True))


@pytest.mark.slow
@pytest.mark.parametrize('name', ['base_onyx_no_preload', 'conic_onyx_preload_5'])
def test_hysteresis_of_the_actuator_is_that_of_the_commanded_torque(shared_path, name):
    """The commanded torque is free of noise: angles where it is zero, ramp by ramp."""
    data = columns(shared_path(f'data/torque_ramps/{name}_position_1.csv'))
    widths = []
    for test in range(5):
        rows = data['test_nr'] == test
        command, position = data['CONTROL_TORQUE'][rows], data['POSITION'][rows]
        highest, lowest = np.argmax(command), np.argmin(command)
        falling = np.abs(command[highest:lowest]) < 0.03
        rising = np.abs(command[lowest:]) < 0.03
        fall, rise = position[highest:lowest][falling], position[lowest:][rising]
        widths.append(np.median(fall) - np.median(rise))
    small = measured(data['TORQUE'], 2.0 * math.pi * data['POSITION']).hysteresis
    assert abs(small.value - 2.0 * math.pi * np.mean(widths)) <= small.uncertainty


def test_a_published_stiffness_is_found(shared_path):
    """arXiv 2510.07197: 242.7 N·m/rad of the whole loop, by lines through either side."""
    data = columns(shared_path('data/dual_encoders/transmission_stiffness_sspg.csv'))
    angle = data['encoder_pos_rad'] / 7.2
    found = measured(data['output_torque_Nm'], angle, step=0.0, rated=20.0)
    assert found.overall.value == pytest.approx(242.7, rel=0.01)

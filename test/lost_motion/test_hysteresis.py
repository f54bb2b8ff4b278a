"""Figures of hysteresis curves: of simulated gears that are known, and of a measured actuator."""

import csv
import math
from itertools import count, islice
from typing import NamedTuple

import numpy as np
import pytest
from gear_recordings import Gear, creep, quantised, ramps

from gear_kinematics.lost_motion.recorded.encoder_step import Source, Step
from gear_kinematics.lost_motion.recorded.recording import Loading
from gear_kinematics.lost_motion.static.hysteresis import Figures, Settings, check, figures
from gear_kinematics.lost_motion.static.models import models_of, settled
from gear_kinematics.lost_motion.static.ramps import RampError, find_ramps
from gear_kinematics.state.uncertainty import student_t

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


class Truth(NamedTuple):
    """Expected figures, by the definitions."""

    hysteresis: float
    play: float
    friction: float
    lost_motion: float
    stiffness: float


def truth(gear: Gear) -> Truth:
    def angle(load: float) -> float:
        return load / gear.stiffness + math.copysign(0.5 * gear.play, load)

    def middle(torque: float) -> float:
        return 0.5 * (angle(torque - gear.friction) + angle(torque + gear.friction))

    at = 0.03 * RATED
    return Truth(
        hysteresis=angle(gear.friction) - angle(-gear.friction),
        play=gear.play,
        friction=gear.friction,
        lost_motion=middle(at) - middle(-at),
        stiffness=gear.stiffness,
    )


def measured(torque, angle, step=STEP, rated=RATED) -> tuple[Figures, ...]:
    settings = Settings(rated, (0.15 * rated, 0.5 * rated), step)
    found = settled(Loading(torque, angle, Step(step, Source.GIVEN), measured=True))
    check(found.ramps[-1], step)
    return figures(found.ramps, settings, models_of(found, step).plays)


def estimates(found: tuple[Figures, ...]) -> dict:
    small, large = found[0], found[-1]
    found = {
        'hysteresis': small.hysteresis,
        'play': small.play,
        'friction': small.friction,
        'lost_motion': large.lost_motion,
        'stiffness': large.stiffness[-1].both,
    }
    return {name: estimate for name, estimate in found.items() if estimate}


@pytest.fixture(scope='module')
def angles() -> dict[str, np.ndarray]:
    return {name: creep(gear, TORQUE) for name, gear in GEARS.items()}


def recorded(angle, noise: float, seed: int):
    """Add noise to the torque and quantise the angle, from a zero of the encoder that differs."""
    generator = np.random.default_rng(seed)
    torque = TORQUE + noise * generator.standard_normal(len(TORQUE))
    return torque, quantised(angle + generator.uniform(0.0, STEP), STEP)


@pytest.mark.slow
@pytest.mark.parametrize('name', GEARS)
def test_figures_of_an_ideal_recording_are_those_of_the_gear(angles, name):
    expected = truth(GEARS[name])._asdict()
    found = measured(TORQUE, angles[name], step=0.0)
    if not expected['play']:
        assert found[0].play is None
        assert 0.0 <= found[0].play_model.limit < 1e-4
    for figure, estimate in estimates(found).items():
        # The simulation moves in steps of 2 µrad, and the torque in steps of 20 and 100 mN·m.
        tolerance = {'friction': 0.02, 'stiffness': 0.1}.get(figure, 2e-5)
        assert estimate.value == pytest.approx(expected[figure], abs=tolerance), figure


@pytest.mark.slow
def test_stated_uncertainties_hold_over_a_grid_of_noise(angles):
    """Intervals contain the true value as often as stated, and are no wider than that needs."""
    hits: dict[str, list[bool]] = {}
    errors: dict[str, list[float]] = {}
    widths: dict[str, list[float]] = {}
    seeds = count()  # with the same noise, what holds for one gear would hold for all
    for name, gear in GEARS.items():
        expected = truth(gear)._asdict()
        for noise in NOISES:
            for seed in islice(seeds, 4):
                found = estimates(measured(*recorded(angles[name], noise, seed)))
                for figure, estimate in found.items():
                    error = estimate.value - expected[figure]
                    hits.setdefault(figure, []).append(abs(error) <= estimate.uncertainty)
                    if noise == NOISES[-1]:
                        # Relative to the values of each gear, so that gears can be combined.
                        errors.setdefault(figure, []).append(error / estimate.uncertainty)
                    widths.setdefault(f'{name} {figure}', []).append(estimate.uncertainty)
    for figure, held in hits.items():
        # Two gears have no play. That they have one is as rare an error as any other.
        assert 32 <= len(held) <= 34 if figure == 'play' else len(held) == 64
        # Of 64 intervals of 95 %, fewer than 55 hold the truth once in 1000 times, of 32 than 26.
        assert sum(held) >= (26 if figure == 'play' else 55), figure
    for figure, relative in errors.items():
        # Where noise dominates, an interval is a few times the error, not many times.
        assert np.sqrt(np.mean(np.square(relative))) > 0.1, figure
    for figure, limit in (('hysteresis', 4e-4), ('play', 3e-4), ('friction', 0.05)):
        for name in GEARS:
            if found := widths.get(f'{name} {figure}'):
                assert np.median(found) < limit, (name, figure)


@pytest.mark.slow
def test_many_repeats_do_not_hide_that_noise_rounds_the_curve():
    """The gear goes through its play at a torque of 1 N·m; lost motion is read at 1.2 N·m."""
    torque = ramps(*[(LARGE, 400)] * 10)
    angle = creep(GEARS['backlash'], torque)
    expected = truth(GEARS['backlash']).lost_motion
    for seed in range(8):
        noisy = torque + 0.1 * np.random.default_rng(seed).standard_normal(len(torque))
        (found,) = measured(noisy, angle, step=0.0)
        assert abs(found.lost_motion.value - expected) <= found.lost_motion.uncertainty


def test_repeats_that_differ_widen_the_interval():
    gear, count = Gear(0.02, 300.0, 1.0), 200
    torque = ramps(*[(SMALL, count)] * 5)
    angle = creep(gear, torque)
    more = [0.0, 2e-3, -1e-3, 0.5e-3, 1e-3]
    for k, offset in enumerate(more):
        zero = 4 * count * k + 2 * count  # where the torque of this test falls through it
        angle[zero - 50 : zero + 50] += offset
    (found,) = measured(torque, angle, step=0.0, rated=SMALL)
    assert found.hysteresis.value == pytest.approx(0.02 + 2 / 300.0 + np.mean(more), abs=1e-5)
    spread = np.std(more, ddof=1) / math.sqrt(5) * student_t(4)
    assert found.hysteresis.uncertainty == pytest.approx(spread, rel=0.01)


def test_ranges_of_stiffness_and_both_signs():
    # Softer for negative torque, and harder from 20 N·m on.
    torque = ramps((40.0, 800), (40.0, 800), (40.0, 800))
    load = np.abs(torque)
    angle = np.where(load < 20.0, load / 200.0, 20.0 / 200.0 + (load - 20.0) / 500.0)
    angle = np.where(torque < 0.0, -2.0 * angle, angle)
    (found,) = measured(torque, angle, step=0.0)
    ranges = [(round(s.low, 3), round(s.high, 3)) for s in found.stiffness]
    assert ranges == [(0.0, 6.0), (6.0, 20.0), (20.0, 40.0)]
    for stiffness, expected in zip(found.stiffness, (200.0, 200.0, 500.0), strict=True):
        assert stiffness.positive.value == pytest.approx(expected, rel=1e-3)
        assert stiffness.negative.value == pytest.approx(0.5 * expected, rel=1e-3)
        # The mean of both compliances.
        assert stiffness.both.value == pytest.approx(expected / 1.5, rel=1e-3)


def test_ranges_that_the_ramps_do_not_reach_are_left_out():
    torque = ramps(*[(6.5, 200)] * 3)
    (found,) = measured(torque, creep(GEARS['soft'], torque), step=0.0)
    assert [(s.low, round(s.high, 2)) for s in found.stiffness] == [(0.0, 6.0)]


def test_play_is_that_of_small_ramps_alone():
    """Small ramps alone, of a gear that is rated far higher: no stiffness is clear of its play."""
    torque = ramps(*[(SMALL, 200)] * 3)
    (found,) = measured(torque, creep(GEARS['backlash'], torque), step=0.0, rated=RATED)
    assert [(s.low, round(s.high, 2)) for s in found.stiffness] == [(0.0, SMALL)]
    assert found.play.value == pytest.approx(0.02, abs=2e-5)
    assert found.hysteresis.value == pytest.approx(truth(GEARS['backlash']).hysteresis, abs=2e-5)


def test_a_range_that_friction_holds_has_no_stiffness():
    """From the peak at -4 N·m on, a friction of ±2.5 N·m holds it up to +1 N·m."""
    torque = ramps(*[(4.0, 200)] * 3)
    (found,) = measured(torque, creep(Gear(0.02, 300.0, 2.5), torque), step=0.0, rated=4.0)
    assert [round(s.low, 3) for s in found.stiffness] == [0.6, 2.0]


@pytest.mark.parametrize('offset', [0.0, 0.1, -1e3])
def test_angle_that_does_not_follow_the_torque_is_refused(offset):
    torque = ramps(*[(SMALL, 200)] * 3)
    for angle in (0.0 * torque, -torque / 300.0):
        with pytest.raises(RampError, match='does not grow with the torque'):
            measured(torque, angle + offset, step=0.0, rated=SMALL)


def test_no_lost_motion_beyond_the_ramps():
    torque = ramps((1.0, 200), (1.0, 200))
    (found,) = measured(torque, creep(Gear(0.01, 300.0, 0.2), torque), step=0.0)
    assert found.lost_motion is None
    assert found.hysteresis.value == pytest.approx(0.01 + 0.4 / 300.0, abs=1e-5)


def test_single_ramp_has_figures_but_no_uncertainty():
    torque = ramps((SMALL, 300))
    (found,) = measured(torque, creep(GEARS['backlash'], torque), rated=SMALL)
    assert found.loops == 1
    assert found.hysteresis.value == pytest.approx(truth(GEARS['backlash']).hysteresis, abs=1e-4)
    assert found.play.value == pytest.approx(0.02, abs=2e-4)
    for estimate in (found.hysteresis, found.play, found.friction):
        assert estimate.uncertainty is None


# The measured actuator

FILES = (
    'base_onyx_no_preload',
    'conic_onyx_preload_1',
    'conic_onyx_preload_2',
    'conic_onyx_preload_3',
    'conic_onyx_preload_4',
    'conic_onyx_preload_5',
)


def columns(path) -> dict[str, np.ndarray]:
    with path.open(encoding='utf-8') as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


@pytest.fixture(scope='module', params=FILES)
def actuator_test(request, shared_path):
    data = columns(shared_path(f'data/torque_ramps/{request.param}_position_1.csv'))
    return request.param, data


@pytest.mark.slow
def test_preload_shows_in_the_hysteresis_of_the_actuator(actuator_test):
    name, data = actuator_test
    small, large = measured(data['TORQUE'], 2.0 * math.pi * data['POSITION'])
    assert (small.loops, large.loops) == (5, 3)
    assert small.amplitude == pytest.approx(4.0, abs=0.1)
    width = np.degrees(small.hysteresis.value)
    spread = np.degrees(small.hysteresis.uncertainty)
    limit = small.play_model.limit
    if name in FILES[:2]:
        assert 1.5 < width - spread < width + spread < 2.0
        assert limit is None or np.degrees(limit) > 0.5
    else:
        assert width + spread < 1.0
        assert np.degrees(limit) < width


@pytest.mark.slow
def test_hysteresis_of_the_actuator_is_that_of_the_commanded_torque(actuator_test):
    """The commanded torque is free of noise: angles where it is zero, ramp by ramp."""
    _, data = actuator_test
    widths = []
    for test in range(5):
        rows = data['test_nr'] == test
        command, position = data['CONTROL_TORQUE'][rows], data['POSITION'][rows]
        highest, lowest = np.argmax(command), np.argmin(command)
        falling = np.abs(command[highest:lowest]) < 0.03
        at_the_end = np.abs(command[lowest:]) < 0.03
        widths.append(
            np.median(position[highest:lowest][falling]) - np.median(position[lowest:][at_the_end])
        )
    small, _ = measured(data['TORQUE'], 2.0 * math.pi * data['POSITION'])
    expected = 2.0 * math.pi * np.mean(widths)
    assert abs(small.hysteresis.value - expected) <= small.hysteresis.uncertainty


@pytest.mark.slow
def test_ramps_of_the_actuator_repeat_within_their_uncertainty(shared_path):
    """Each ramp lies in the 95 % prediction interval of the others."""
    inside = total = 0
    for name in FILES:
        data = columns(shared_path(f'data/torque_ramps/{name}_position_1.csv'))
        ramps_found = find_ramps(data['TORQUE'], 2.0 * math.pi * data['POSITION'])
        widths = np.array([loop.width(0.0) for loop in ramps_found[0].loops])
        for k, width in enumerate(widths):
            others = np.delete(widths, k)
            count = len(others)
            reach = student_t(count - 1) * np.std(others, ddof=1) * math.sqrt(1 + 1 / count)
            inside += abs(width - others.mean()) <= reach
            total += 1
    assert total == 30
    # Of 30, fewer than 25 would be inside once in 300 times.
    assert inside >= 25

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A delay between the stamps of both encoders is no lost motion, and another ratio no error."""

import math
from dataclasses import replace
from itertools import accumulate

import numpy as np
import pytest
from gear_recordings import encoders
from simulated_encoders import (
    ARC_MINUTE,
    TURN,
    Drive,
    even_strokes,
    ramped_strokes,
    sine_strokes,
    stamps,
    with_play,
)

from gear_kinematics.kinematics import GearRatio
from gear_kinematics.measurement.ratio import check_ratio
from gear_kinematics.measurement.recording import Encoders, RecordingError
from gear_kinematics.measurement.transmission import transmission_figures

RATIO = GearRatio(-19)
PLAY = 3.0 * ARC_MINUTE
ERRORS = {order: size * ARC_MINUTE for order, size in {1: 4, 19: 1, 20: 0.3, 1520: 0.1}.items()}
COUNTS, OUTPUT_COUNTS = 2**16, 2**20
STEPS = {'rotor_step': TURN / COUNTS, 'output_step': TURN / OUTPUT_COUNTS}


TRAVEL = math.radians(1.0)


def recorded(drive, profile, seconds, rate=1000.0, seed=1) -> Encoders:
    times, rotor, output = drive.readings(profile, seconds, rate, seed)
    return encoders(rotor, output, stamps(times), COUNTS, OUTPUT_COUNTS)


def figures(both: Encoders):
    return transmission_figures(both, RATIO, TRAVEL)


@pytest.mark.slow
@pytest.mark.parametrize('delay', [0.0, -2e-3, 10e-3])
@pytest.mark.parametrize(
    'profile',
    [sine_strokes(3.0, 4.0), ramped_strokes(3.0, 2.0, 0.3), sine_strokes(0.5, 2.0)],
    ids=['sine', 'ramped', 'short'],
)
def test_delay_is_told_from_play_and_taken_out(profile, delay):
    drive = Drive(PLAY, ERRORS, delay, noise=0.05 * ARC_MINUTE, **STEPS)
    found = figures(recorded(drive, profile, 16.0))
    assert found.lost_motion.value == pytest.approx(PLAY, abs=0.06 * ARC_MINUTE)
    assert 0.0 < found.lost_motion.uncertainty < 0.15 * ARC_MINUTE
    assert found.delay.value == pytest.approx(delay, abs=2e-5)
    assert found.delay.uncertainty < 5e-5
    clean = figures(recorded(Drive(PLAY, ERRORS, **STEPS), profile, 16.0)).forward.value
    assert -0.1 * ARC_MINUTE < found.forward.value - clean < 2 * 4.5 * drive.noise


@pytest.mark.slow
@pytest.mark.parametrize('clock', [0.0, 2e-4])
def test_slow_drifts_of_zero_and_clock_are_no_play(clock):
    """As of a gear that warms up, and of two boards each with a crystal."""
    drive = Drive(PLAY, ERRORS, noise=0.05 * ARC_MINUTE, **STEPS)
    times, rotor, output = drive.readings(ramped_strokes(3.0, 9.0, 2.0), 16.0, 1000.0, 1)
    output = np.interp((1.0 + clock) * times, times, output) + 2.0 * ARC_MINUTE * times / 16.0
    found = figures(encoders(rotor, output, stamps(times), COUNTS, OUTPUT_COUNTS))
    assert found.lost_motion.value == pytest.approx(PLAY, abs=0.06 * ARC_MINUTE)
    assert found.lost_motion.uncertainty < 0.5 * ARC_MINUTE


@pytest.mark.slow
def test_a_zero_that_walks_at_random_is_in_the_uncertainty():
    """Two to eight strokes show little of how far it walks from one to the next."""
    inside, seeds = 0, 40
    for seed in range(seeds):
        strokes = 2 + seed % 7
        drive = Drive(PLAY, ERRORS, noise=0.05 * ARC_MINUTE, **STEPS)
        profile = ramped_strokes(3.0, 5.0, 1.0)
        times, rotor, output = drive.readings(profile, 5.0 * strokes, 50.0, seed)
        steps = np.random.default_rng([seed, 1]).normal(size=len(times))
        output += 2.0 * ARC_MINUTE * np.cumsum(steps) / math.sqrt(len(times))
        found = figures(encoders(rotor, output, stamps(times), COUNTS, OUTPUT_COUNTS)).reversals
        inside += abs(found.value - PLAY) <= found.uncertainty
    # By the scatter of blocks alone, 28 of 40 are.
    assert inside >= 34


@pytest.mark.slow
def test_a_filter_of_the_output_is_no_play():
    """It delays less while strokes begin and end, which become ever faster."""
    drive = Drive(PLAY, ERRORS, noise=0.05 * ARC_MINUTE, **STEPS)
    strokes = ramped_strokes(5.0, 9.0, 0.7)
    times, rotor, output = drive.readings(lambda t: strokes(t * (0.5 + t / 30.0)), 30.0, 100.0, 1)
    share = 1.0 - math.exp(-0.01 / 0.02)
    filtered = np.array([*accumulate(output, lambda one, next_: one + share * (next_ - one))])
    found = figures(encoders(rotor, filtered, stamps(times), COUNTS, OUTPUT_COUNTS))
    assert found.lost_motion.value == pytest.approx(PLAY, abs=0.1 * ARC_MINUTE)


@pytest.mark.slow
def test_delay_at_one_speed_is_not_called_play():
    drive = Drive(PLAY, ERRORS, 2e-3, **STEPS)
    both = recorded(drive, even_strokes(3.0, 1.0), 16.0)
    found = figures(both)
    assert found.lost_motion is found.delay is None
    assert found.reversals.value == pytest.approx(PLAY + 2e-3 * 6.0, rel=1e-2)


@pytest.mark.slow
def test_intervals_hold_for_any_seed():
    inside, seeds, off = 0, 40, []
    for seed in range(seeds):
        random = np.random.default_rng(seed)
        play, delay = random.uniform(0, 10) * ARC_MINUTE, random.uniform(-5e-3, 5e-3)
        noise = random.uniform(0, 0.5) * ARC_MINUTE
        drive = Drive(play, ERRORS, delay, noise, **STEPS)
        stroke, time = random.uniform(0.5, 3.0), random.uniform(1.0, 4.0)
        even = seed % 2  # where the speed hardly varies, a delay is hardly told from play
        profile = ramped_strokes(stroke, time, 0.15 * time) if even else sine_strokes(stroke, time)
        found = figures(recorded(drive, profile, 12.0, 250.0, seed))
        for estimate, true in ((found.lost_motion, play), (found.delay, delay)):
            inside += abs(estimate.value - true) <= estimate.uncertainty
        off.append(found.lost_motion.value - play)
    # 95 % of 80: fewer than 70 have a probability of less than 1 %.
    assert inside >= 70
    assert np.std(off) < 0.07 * ARC_MINUTE


@pytest.mark.parametrize('weight', [0.6, -0.6])
def test_play_that_varies_under_a_weight_is_no_delay(weight):
    """The weight of an arm closes the play, but not where it hangs down."""
    times = np.arange(0.0, 20.0, 0.004)
    ideal = sine_strokes(1.5, 2.0)(times * (0.6 + times / 40.0)) - 0.75
    side = with_play(ideal, PLAY) - ideal
    drive = Drive(0.0, {1: 4.0 * ARC_MINUTE})
    share = 1.0 + weight * np.cos(2.0 * ideal)
    output = np.interp(times - 0.003, times, drive.output(ideal) + share * side)
    output += 0.02 * ARC_MINUTE * np.random.default_rng(1).normal(size=len(times))
    found = figures(encoders(-19.0 * ideal, output, stamps(times), COUNTS, OUTPUT_COUNTS))
    trues = PLAY * np.mean(share), 0.003
    for estimate, true in zip((found.lost_motion, found.delay), trues, strict=True):
        assert abs(estimate.value - true) <= estimate.uncertainty
    assert found.lost_motion.uncertainty < ARC_MINUTE
    assert found.delay.uncertainty < 2e-4


def test_even_play_does_not_seem_to_vary_by_chance():
    play = 8.45075 * ARC_MINUTE
    drive = Drive(play, ERRORS, -0.0033903, 0.27887 * ARC_MINUTE, **STEPS)
    found = figures(recorded(drive, sine_strokes(1.42020, 1.64483), 12.0, 250.0, 17))
    assert abs(found.lost_motion.value - play) <= found.lost_motion.uncertainty < 0.2 * ARC_MINUTE


# Another ratio


SHORT, LONG = (sine_strokes(0.5, 2.0), 0.7), (sine_strokes(14.0, 8.0), 1e-3)


@pytest.mark.parametrize(
    ('assumed', 'profile', 'spread'),
    [
        *((assumed, *SHORT) for assumed in ('-15', '-24', '19')),
        *((assumed, *LONG) for assumed in ('-18', '-20', '-58/3', '19')),
    ],
)
def test_ratio_of_a_recording_is_named_with_its_uncertainty(assumed, profile, spread):
    drive = Drive(PLAY, ERRORS, noise=0.3 * ARC_MINUTE, **STEPS)
    both = recorded(drive, profile, 16.0, 100.0)
    try:
        said = str(check_ratio(both, GearRatio.parse(assumed)))
    except RecordingError as error:
        said = str(error)
    value, _, uncertainty, *_ = said.split('the recorded ratio is ')[1].split()
    assert abs(float(value) + 19) <= float(uncertainty.rstrip(',')) <= spread
    assert f'not {assumed}' in said
    assert '--ratio=-19' in said
    assert ('an encoder counts backwards' in said) == (assumed == '19')
    assert ('gearkin commission' in said) == (assumed != '19')


@pytest.mark.parametrize('assumed', ['-18', '-20', '-58/3'])
def test_ratio_within_what_an_encoder_of_a_degree_tells_is_not_called_wrong(assumed):
    drive = Drive(PLAY, ERRORS, noise=0.3 * ARC_MINUTE, **STEPS)
    assert not check_ratio(recorded(drive, SHORT[0], 16.0, 100.0), GearRatio.parse(assumed))


@pytest.mark.parametrize('eccentricity', [0.0, 20.0 * ARC_MINUTE])
@pytest.mark.parametrize(
    'profile', [even_strokes(3.0, 2.0), sine_strokes(0.1, 2.0), sine_strokes(6.0, 4.0)]
)
def test_right_ratio_is_not_doubted(profile, eccentricity):
    for seed in range(5):
        drive = Drive(PLAY, ERRORS | {1: eccentricity}, 2e-3, 0.2 * ARC_MINUTE, **STEPS)
        assert not check_ratio(recorded(drive, profile, 16.0, 100.0, seed), RATIO)


LATE = 4e-3
"""Delay of the output, s, whose encoder is read at about 100 Hz."""


def fast(time):
    """Output angle at times, s: sines of up to 13 rad/s²."""
    return 2.0 * np.sin(2.6 * time)


def without_delay(time, **changes) -> Encoders:
    """Both encoders, read at the same times, after the delay of the output is removed."""
    both = encoders(-19.0 * fast(time), fast(time - LATE), np.round(1e9 * time).astype(np.int64))
    rotor = both.rotor._replace(**changes)
    return replace(both, rotor=rotor).earlier(LATE)


def turned(both: Encoders) -> np.ndarray:
    turns, angle = both.position()
    return turns * TURN + angle


@pytest.mark.parametrize('jitter', [0.0, 2e-3])
def test_the_rotor_between_its_samples_accelerates(jitter):
    """The line between two samples is off by 3.2e-3 rad of the rotor."""
    time = np.arange(1000) / 100.0
    time += jitter * np.random.default_rng(1).uniform(-1.0, 1.0, len(time))
    both = without_delay(np.sort(time))
    inside = both.chosen(np.flatnonzero((both.before > 0) & (both.before < len(time) - 2)))
    np.testing.assert_allclose(turned(inside), -19.0 * inside.measured, rtol=0, atol=4e-6)


@pytest.mark.parametrize('unknown', ['ends', 'segment', 'one time', 'gap'])
def test_the_rotor_moves_evenly_where_samples_around_are_missing(unknown):
    time, changes = np.arange(12) / 100.0, {}
    if unknown == 'segment':
        changes['segment'] = np.repeat([0, 1], [6, 6])
    if unknown == 'one time':
        time[6] = time[5]
    if unknown == 'gap':
        time[6:] += 0.05
    both = without_delay(time, **changes)
    before = {'ends': [0, 10], 'segment': [4, 5, 6], 'one time': [4, 6], 'gap': [5]}[unknown]
    rows = np.flatnonzero(np.isin(both.before, before))
    assert set(both.before[rows].tolist()) == set(before)
    even = np.interp(both.seconds, both.rotor.seconds, -19.0 * fast(time))
    np.testing.assert_allclose(turned(both)[rows], even[rows], rtol=0, atol=1e-12)


@pytest.mark.parametrize('speed', [0.01, 0.1, 1.0])
def test_coarse_readings_of_the_rotor_are_hardly_noisier_than_on_a_line(speed):
    time, step = np.arange(6000) / 100.0, TURN / 256
    motion = speed * np.sin(time)
    rotor = step * np.round(-19.0 * motion / step)
    output = speed * np.sin(time - LATE)
    both = encoders(rotor, output, np.round(1e9 * time).astype(np.int64)).earlier(LATE)
    line = np.interp(both.seconds, time, rotor) + 19.0 * both.measured
    assert np.std(turned(both) + 19.0 * both.measured) < 1.05 * np.std(line)

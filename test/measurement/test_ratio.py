# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The gear ratio that is estimated from simulated angles of rotor and output."""

import math
from dataclasses import replace
from fractions import Fraction
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from gear_recordings import encoders, two_encoders_at_one_shaft
from simulated_encoders import TURN, with_play

from gear_kinematics.kinematics import GearRatio
from gear_kinematics.measurement.calibration import fit
from gear_kinematics.measurement.columns import Sources
from gear_kinematics.measurement.commissioning.analysis import Channel, Request, commission
from gear_kinematics.measurement.lost_motion import measure
from gear_kinematics.measurement.ratio import estimate_ratio, not_followed, wrong_ratio
from gear_kinematics.measurement.reading import read
from gear_kinematics.measurement.recording import Recording, RecordingError
from gear_kinematics.measurement.sentences import Observation
from gear_kinematics.parameters import NodeParameters

MOTIONS = 'sweep', 'there and back', 'sine', 'jog', 'hand'


def moved(travel, motion, time, random):
    """Output angles of a motion, rad."""
    share, span = time / time[-1], time[-1]
    if motion == 'sweep':
        ideal = share
    elif motion == 'there and back':
        ideal = 1.0 - np.abs(2.0 * share - 1.0)
    elif motion == 'sine':
        ideal = np.sin(TURN * random.uniform(1.5, 6.5) * share + random.uniform(0.0, TURN))
    elif motion == 'jog':  # from place to place, and standstill
        places = np.concatenate([[0.0, 1.0], random.uniform(size=random.integers(5, 12))])
        ideal = np.interp(share, np.linspace(0.0, 1.0, 2 * len(places)), np.repeat(places, 2))
        width = max(3, int(0.1 * len(time) / span))
        ideal = np.convolve(np.pad(ideal, width, 'edge'), np.full(width, 1.0 / width), 'same')
        ideal = ideal[width:-width]
    else:
        walk = np.cumsum(np.cumsum(random.normal(size=len(time) // 20 + 2)))
        ideal = np.interp(np.arange(len(time)), 20.0 * np.arange(len(walk)), walk)
    return travel * (ideal - ideal.min()) / np.ptp(ideal) + random.uniform(-3.0, 3.0)


def encoder_error(angle, amplitude, kind, phase):
    """Compute the error of an eccentric disc, or of unequal, shifted signals of a magnet, rad."""
    unequal = kind == 'elliptic'
    shift = (0.5 if unequal else 1.0) * math.sin(amplitude)
    gain = (1.0 + amplitude) / (1.0 - amplitude) if unequal else 1.0
    true = angle + phase
    read = np.arctan2(gain * np.sin(true), np.cos(true) - shift)
    return np.remainder(read - true + math.pi, TURN) - math.pi


def pitch_error(angle, steps):
    """Cumulative error of teeth, a random walk that closes after a turn; its peak is 1."""
    walk = np.cumsum(steps)
    walk -= np.linspace(0.0, walk[-1], len(walk))
    walk = np.append(walk, walk[0]) - walk.mean()
    places = np.mod(angle, TURN) / TURN * len(steps)
    return np.interp(places, np.arange(len(walk)), walk / np.abs(walk).max())


def recorded(ratio, travel, error, random, motion=None):
    """Record rotor, output and times of a joint by the geometry of its errors: no sines of orders.

    The errors over a turn, of gear and encoder together, are at most `error`; angles are in rad.
    """
    rate, seconds = float(random.choice([100, 250, 500, 1000])), random.uniform(8.0, 40.0)
    motion = motion or str(random.choice(MOTIONS))
    time = np.arange(int(rate * seconds)) / rate
    ideal = moved(travel, motion, time, random)
    rotor = float(ratio) * ideal
    output = with_play(ideal, random.uniform(0.0, 0.5) * error)
    kinds = random.choice(['eccentric', 'elliptic'], 2)
    phases = random.uniform(0.0, TURN, 4)
    teeth, sag = random.normal(size=random.integers(20, 90)), random.uniform(0.0, 0.5)
    share = random.uniform()

    def periodic(angle):  # the sag is wind-up by gravity
        encoder = encoder_error(angle, error, kinds[0], phases[0]) / error
        return encoder + share * pitch_error(angle, teeth) + sag * np.sin(angle + phases[1])

    peak = 0.5 * np.ptp(periodic(np.linspace(0.0, TURN, 2000)))
    twice = random.uniform(0.0, 0.1) * error * np.sin(2.0 * rotor + phases[2])
    measured = output + twice + random.uniform(0.5, 1.0) * error * periodic(output) / peak
    rotor = rotor + encoder_error(rotor, random.uniform(0.3, 1.0) * error, kinds[1], phases[3])
    delay = random.choice([0.0, random.uniform(-0.004, 0.004)])
    measured = np.interp(time - delay, time, measured)
    stamps = np.maximum.accumulate(time + random.normal(scale=2e-4, size=len(time)))
    read = []
    for angle, bits in ((rotor, random.choice([12, 14, 17])), (measured, random.choice([12, 20]))):
        step = TURN / 2.0**bits
        read.append(step * np.round(angle / step + random.normal(scale=0.3, size=len(angle))))
    inside = slice(int(0.02 * rate) + 1, -int(0.02 * rate) - 1)  # without the ends of the delay
    return read[0][inside], read[1][inside], stamps[inside]


def angles(ratio, turns, *, seed=0, count=4000, noise=1e-4, there_and_back=False):
    """Angles of rotor and output: eccentricities, play and noise that decays over 30 samples."""
    random = np.random.default_rng(seed)
    share = np.linspace(0.0, 1.0, count)
    if there_and_back:
        share = 1.0 - np.abs(2.0 * share - 1.0)
    ideal = turns * TURN * share
    rotor = float(ratio) * ideal
    decay = np.exp(-np.arange(300) / 30.0)
    coloured = np.convolve(random.normal(size=count + 299), decay, 'valid')
    error = noise * coloured / np.linalg.norm(decay)
    error += 1e-3 * np.sin(ideal + random.uniform(0.0, TURN))
    error += 5e-4 * np.sin(rotor + random.uniform(0.0, TURN))
    error += 5e-4 * np.sign(np.gradient(ideal))
    return rotor, ideal + error + random.uniform(-3.0, 3.0)


@pytest.mark.parametrize(('ratio', 'turns'), [(Fraction(-19), 2.2), (Fraction(1457, 26), 40.0)])
def test_ratio_is_found_exactly(ratio, turns):
    found = estimate_ratio(*angles(ratio, turns, noise=1e-5))
    assert (found.taken, found.candidates) == (ratio, (ratio,))
    assert isinstance(found.taken, GearRatio)
    assert not found.advice


@pytest.mark.parametrize(
    ('amplitude', 'period', 'late'),
    [(0.5, 0.001, 0.004), (2.0, 0.005, 0.001), (6.0, 0.005, 0.002)],  # rad, s, s
)
def test_a_delay_of_encoders_without_noise_makes_no_ratio_wrong(amplitude, period, late):
    """As from a simulation: the rotor is interpolated to the times before the delay."""
    time = period * np.arange(4000)
    rotor, output = (amplitude * np.sin(t) for t in (time, time - late))
    found = estimate_ratio(-19.0 * rotor, output + 1e-4 * np.sin(5.0 * output), time)
    assert abs(found.measured.value + 19.0) <= found.measured.expanded


TRAVELS = 20, 60, 298, 450, 1800  # deg
RATIOS = Fraction(-19), Fraction(36, 5), Fraction(101), Fraction(1457, 26)


@pytest.mark.slow
@pytest.mark.parametrize('error', [0.05, 0.3, 1.0])
def test_interval_contains_the_ratio_and_none_is_taken_wrongly(error):
    inside = []
    for seed, (travel, ratio) in enumerate(product(TRAVELS, RATIOS)):
        random = np.random.default_rng(seed)
        joint = recorded(ratio, math.radians(travel), math.radians(error), random)
        found = estimate_ratio(*joint)
        distance = abs(found.measured.value - ratio) / found.measured.uncertainty
        inside.append(distance <= 1.0)
        assert distance <= 2.0
        assert found.taken in {None, ratio}
        if found.taken is None:
            assert found.advice
    # Where 95 % lie inside, fewer than 17 of 20 do in 2 % of cases.
    assert sum(inside) >= 17


def test_a_ratio_is_found_from_few_samples():
    time = np.linspace(0.0, 4.0, 240)
    ideal = 2.0 * TURN * time / 4.0 + np.sin(3.0 * time)
    found = estimate_ratio(-19.0 * ideal, ideal + 1e-4 * np.cos(ideal), time).measured
    assert abs(found.value + 19.0) <= found.expanded < 0.01


@pytest.mark.slow
def test_a_zero_that_walks_at_random_is_in_the_interval():
    """The fit follows most of a walk in three turns, and so shows little of it."""
    inside, share = [], np.linspace(0.0, 1.0, 2000)
    for seed in range(20):
        random = np.random.default_rng(seed)
        ideal = 20.0 * share + 1.5 * np.sin(3.0 * TURN * share)
        walk = np.cumsum(random.normal(size=2000)) / math.sqrt(2000.0)
        noise = 0.2 * random.normal(size=2000)
        error = np.radians((3.0 * np.cos(ideal) + walk + noise) / 60.0)
        found = estimate_ratio(-19.0 * ideal, ideal + error, 20.0 * share).measured
        inside.append(abs(found.value + 19.0) <= found.expanded)
    # With a walk as large as the residual shows, 6 of 20 are.
    assert sum(inside) >= 17


@pytest.mark.parametrize(('turns', 'most'), [(1.25, 2e-3), (5.0, 4e-4)])
def test_over_more_than_a_turn_errors_of_a_degree_repeat(turns, most):
    random = np.random.default_rng(1)
    joint = recorded(-19, turns * TURN, math.radians(1.0), random, 'sine')
    found = estimate_ratio(*joint)
    assert found.taken == -19
    assert abs(found.measured.value + 19.0) <= found.measured.uncertainty <= most


def test_nobody_is_told_to_turn_further_where_that_does_not_help():
    """As of encoders that are polled one after the other: a little off -6, after 87 turns."""
    found = estimate_ratio(*angles(Fraction(-599_991, 100_000), 87.0))
    assert not found.taken
    assert found.advice == Observation.SAMPLE_TOGETHER()


@pytest.mark.parametrize(('unit', 'per_rad'), [('degrees', 180.0 / math.pi), ('turns', 1 / TURN)])
@pytest.mark.parametrize('ratio', [20, -50, 101])
def test_a_rotor_in_another_unit_is_named_beside_the_ratio_that_it_gives(unit, per_rad, ratio):
    rotor, output, time = recorded(ratio, 1.5 * TURN, 1e-3, np.random.default_rng(3), 'sine')
    found = estimate_ratio(rotor * per_rad, output, time)
    assert found.taken is None
    said = f'if the rotor is in {unit}, its ratio is {ratio}: let the driver send rad; else '
    assert str(found.advice).startswith(said)


def test_less_than_a_turn_is_left_open_and_the_advice_is_enough():
    for seed, ratio in enumerate((Fraction(-19), Fraction(101))):
        joint = recorded(
            ratio, math.radians(298.0), math.radians(0.5), np.random.default_rng(seed), 'sweep'
        )
        found = estimate_ratio(*joint)
        assert (found.taken, ratio in found.candidates) == (None, True)
        joint = recorded(
            ratio,
            math.radians(found.advice.values['degrees']),
            math.radians(0.5),
            np.random.default_rng(seed),
            'sweep',
        )
        assert estimate_ratio(*joint).taken == ratio


@pytest.mark.parametrize(
    ('name', 'ratio', 'most'),
    [
        ('neura_jogging_final_joint1', Fraction(121), 0.06),
        ('neura_jogging_joint_mass_joint2', Fraction(121), 0.05),
        ('sspg_backlash_sine_vel_2.500tps_2.00s', Fraction(-36, 5), 0.05),
    ],
)
def test_real_joints_are_left_open_with_the_true_ratio_in_the_interval(
    name, ratio, most, shared_path, config
):
    path = shared_path(f'data/dual_encoders/{name}.csv')
    counts = 2**24 if ratio.denominator == 1 else None
    sources = Sources(rotor_counts=counts, output_counts=counts)
    both = read(path, replace(config, gear_ratio=str(ratio)), sources).both
    found = estimate_ratio(both.at_measured(both.rotor.turned), both.measured, both.seconds)
    assert abs(found.measured.value - ratio) <= found.measured.uncertainty <= most * abs(ratio)
    assert (found.taken, ratio in found.candidates) == (None, True)
    assert not wrong_ratio(both, ratio)
    assert wrong_ratio(both, -ratio).what is Observation.COUNTS_BACKWARDS


def test_what_inertia_winds_up_is_in_the_interval():
    """The output oscillates at 25 Hz on its springs, and goes there and back."""
    time = np.arange(40_000) * 1e-3
    share = 1.0 - np.abs(1.0 - np.mod(time / 2.0, 2.0))
    ideal = 9.0 * (10.0 - 15.0 * share + 6.0 * share**2) * share**3  # least jerk
    lag = np.gradient(np.gradient(ideal, time), time) / (2.0 * math.pi * 25.0) ** 2
    rotor, output = (
        TURN / 2.0**bits * np.round(angle * 2.0**bits / TURN)
        for angle, bits in ((19.0 * ideal, 14), (ideal - lag, 17))
    )
    found = estimate_ratio(rotor, output, time)
    assert abs(found.measured.value - 19.0) < found.measured.uncertainty
    assert found.taken == 19


@pytest.mark.parametrize(
    ('ratio', 'beyond', 'taken'),
    [('-19', 1.6, True), ('-58/3', 1.6, False), ('-19', 2.4, False)],  # of 3 there are more
)
def test_ratio_a_little_beyond_its_interval_is_taken_if_it_can_be_no_coincidence(
    ratio, beyond, taken
):
    measured = estimate_ratio(*angles(Fraction(ratio), 1.5)).measured
    off = beyond * measured.expanded + float(Fraction(ratio)) - measured.value
    found = estimate_ratio(*angles(float(Fraction(ratio)) + off, 1.5))
    assert found.taken == (Fraction(ratio) if taken else None)


def test_a_ratio_that_is_no_simple_fraction_is_not_taken():
    found = estimate_ratio(*angles(-math.pi * math.e, 5.0))
    assert found.taken is None
    assert abs(found.measured.value + math.pi * math.e) <= found.measured.uncertainty


@pytest.mark.parametrize('encoder', ['multi_turn', 'single_turn'])
@pytest.mark.parametrize('assumed', [-19, 3])
def test_a_wrong_ratio_is_named_with_the_recorded_one(assumed, encoder):
    rotor, output = angles(Fraction(-58, 3), 6.0, noise=1e-5)
    if encoder == 'single_turn':
        output = output % TURN
    what, values = wrong_ratio(encoders(rotor, output), GearRatio(assumed))
    assert (what, values['assumed']) == (Observation.ANOTHER_RATIO, assumed)
    assert values['ratio'] == Fraction(-58, 3)
    assert values['measured'].value == pytest.approx(-58 / 3, abs=5e-3)


@pytest.mark.parametrize('speed', [100.0, 300.0])
def test_a_fast_output_does_not_seem_to_wrap(speed):
    """Between two rows it turns by up to 1 or 3 rad, and by twice that against a wrong sign."""
    rotor, output, time = two_encoders_at_one_shaft(speed, seed=1)
    both = encoders(rotor, output, np.round(1e9 * time).astype(np.int64))
    assert wrong_ratio(both, GearRatio(-1)) is None
    what, values = wrong_ratio(both, GearRatio(1))
    assert (what, values['ratio']) == (Observation.COUNTS_BACKWARDS, -1)
    assert abs(values['measured'].value + 1.0) < 2.0 * values['measured'].expanded < 0.01


def test_two_encoders_at_one_shaft_are_not_to_be_exchanged():
    """The coupling between them twists by one and a half times the ±, as on a test bench."""
    rotor, output, time = two_encoders_at_one_shaft(20.0, seed=1)
    twisted = output * (1.0 + 1.5 * estimate_ratio(rotor, output, time).measured.expanded)
    assert wrong_ratio(encoders(rotor, twisted, np.round(1e9 * time)), GearRatio(-1)) is None


@pytest.mark.parametrize(('counts', 'ratio'), [(4096, -76), (8192, -38)])
def test_counts_per_turn_that_are_too_few_are_suspected(counts, ratio):
    """An encoder of 16384 counts a turn."""
    rotor, output = angles(Fraction(-19), 6.0, noise=1e-5)
    what, values = wrong_ratio(encoders(rotor * 16384 / counts, output), GearRatio(-19))
    assert (what, values['ratio']) == (Observation.MULTIPLE_RATIO, ratio)


@pytest.mark.parametrize('unit', [180.0 / math.pi, math.tau])
def test_angles_in_different_units_are_suspected(unit):
    """The rotor in degrees, or the output in turns, taken for rad."""
    rotor, output = angles(Fraction(-19), 6.0, noise=1e-5)
    what, values = wrong_ratio(encoders(rotor * unit, output), GearRatio(-19))
    assert what is Observation.MULTIPLE_RATIO
    assert float(values['ratio']) == pytest.approx(-19.0 * unit, rel=1e-3)


@pytest.mark.parametrize(
    ('rotor', 'output', 'cause'),
    [
        (np.arange(230.0), np.arange(230.0), '229 samples in motion are too few.* 230'),
        (np.arange(1000.0), 7.0 * np.arange(1000.0), 'more than the rotor: exchange'),
        (
            np.arange(1000.0),
            np.random.default_rng(0).normal(size=1000),
            'the output does not follow the rotor',
        ),
    ],
)
def test_angles_without_a_ratio_are_refused(rotor, output, cause):
    with pytest.raises(RecordingError, match=cause):
        estimate_ratio(rotor, output)


@pytest.mark.parametrize('rate', [5.0, 100.0], ids=['wraps too fast', 'wraps not counted'])
@pytest.mark.parametrize('travel', [340.0, 4000.0])
def test_a_rotor_that_wraps_is_named_and_no_ratio_is_proposed(rate, travel):
    """Such a rotor has no ratio, whether it turns less than the output or not."""
    time = np.arange(0.0, 60.0, 1.0 / rate)
    output = 0.5 * math.radians(travel) * np.sin(0.4 * time)
    rotor = np.remainder(-19.0 * output, TURN)
    wraps = Observation.WRAPS_UNCOUNTED()
    both = encoders(rotor, output, np.round(1e9 * time).astype(np.int64))
    assert wrong_ratio(both, GearRatio(-19)) == wraps
    with pytest.raises(RecordingError, match=str(wraps)):
        estimate_ratio(rotor, output, time)


SECONDS = np.arange(1500) * 0.02
JOINT = 0.5 * np.sin(0.7 * SECONDS)  # rad


@pytest.mark.parametrize(
    ('output', 'related'),
    [
        (1e-3 * SECONDS, False),
        (0.4 * np.sin(0.3 * SECONDS + 1.0), False),  # another joint
        (1e-3 * np.sign(np.cos(0.7 * SECONDS)), False),  # a current, which friction causes
        (JOINT + np.radians(2.0) * np.sin(3.0 * JOINT + 1.0), True),  # two bad encoders
        (np.interp(SECONDS - 0.2, SECONDS, JOINT), True),
    ],
)
def test_an_output_that_the_rotor_does_not_move_is_neither_calibrated_nor_measured(
    output, related
):
    noise = 1e-5 * np.random.default_rng(0).normal(size=len(SECONDS))
    both = encoders(-19.0 * JOINT, output + noise, np.round(1e9 * SECONDS).astype(np.int64))
    recording = Recording(Path('gear'), 'gear', (), len(noise), both)
    assert (measure(recording, NodeParameters.load()).wrong_ratio is None) is related
    if related:
        fit([replace(recording, path=Path(__file__))], Fraction(-19))
    else:
        with pytest.raises(RecordingError, match=r'gear: .* not have the ratio -19: .*too little'):
            fit([recording], Fraction(-19))


@pytest.mark.parametrize('sampled', [1, 10])
@pytest.mark.parametrize('play', [0.0, 0.45])
def test_an_output_with_much_play_and_noise_follows_its_rotor(sampled, play):
    noise = 0.2 * np.random.default_rng(1).normal(size=len(JOINT))
    error = with_play(JOINT, play) + noise - JOINT
    assert not_followed(JOINT[::sampled], error[::sampled], Fraction(-19)) is None
    assert not_followed(JOINT[::sampled], noise[::sampled] - JOINT[::sampled], Fraction(-19))


def test_a_given_ratio_is_not_confirmed_by_a_temperature():
    """Both angles only rise, so that the measured ratio is too uncertain to contradict it."""
    time = np.arange(600) * 0.05
    noise = 1e-4 * np.random.default_rng(0).normal(size=600)
    output = 0.6 * (1.0 - np.exp(-time / 5.0)) + noise
    both = encoders(
        6.0 * (1.0 - np.cos(0.05 * time)), output, np.round(1e9 * time).astype(np.int64)
    )
    recording = Recording(Path('gear'), 'gear', (), 600, both)
    nowhere = Channel('', '')
    result = commission([recording], Request(rotor=nowhere, output=nowhere, ratio=GearRatio(6)))
    assert result.between is None
    assert 'ratio is undetermined: the output does not follow the rotor' in str(result.answer)

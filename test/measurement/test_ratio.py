# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The gear ratio that is estimated from simulated angles of rotor and output."""

import math
from fractions import Fraction

import numpy as np
import pytest
from gear_recordings import encoders

from gear_kinematics.kinematics import GearRatio
from gear_kinematics.measurement.ratio import estimate_ratio, fit_ratio
from gear_kinematics.measurement.recording import RecordingError

TURN = 2.0 * math.pi


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


@pytest.mark.parametrize(
    ('ratio', 'turns'),
    [
        (Fraction(-19), 2.2),
        (Fraction(1457, 26), 40.0),
        (Fraction(-58, 3), 5.0),
        (Fraction(100), 3.0),
        (Fraction(1, 7), 50.0),
        (Fraction(-1), 20.0),
    ],
)
def test_ratio_is_found_exactly(ratio, turns):
    found = estimate_ratio(*angles(ratio, turns, noise=1e-5))
    assert found.ratio == found.simplest == ratio
    assert isinstance(found.ratio, GearRatio)
    assert found.chance < 0.05


@pytest.mark.slow
@pytest.mark.parametrize('there_and_back', [False, True])
def test_uncertainty_contains_the_ratio_as_often_as_it_says(there_and_back):
    ratio, within, trials = Fraction(-19), 0, 200
    for seed in range(trials):
        rotor, output = angles(ratio, 2.3, seed=seed, there_and_back=there_and_back)
        measured = estimate_ratio(rotor, output).measured
        within += abs(measured.value - ratio) <= measured.uncertainty
    # If 95 % is true, less than 90 % and more than 99.5 % are seen in 2 of 1000 cases each.
    assert 0.90 * trials <= within <= 0.995 * trials


def test_estimate_is_taken_where_a_simple_fraction_is_no_evidence():
    rotor, output = angles(-math.pi * math.e, 5.0)
    found = estimate_ratio(rotor, output)
    assert found.chance > 0.05
    assert abs(found.ratio - found.measured.value) <= 1e-3 * found.measured.uncertainty
    assert abs(float(found.ratio) + math.pi * math.e) <= found.measured.uncertainty


@pytest.mark.parametrize('encoder', ['multi_turn', 'single_turn'])
@pytest.mark.parametrize('assumed', [-19, Fraction(1457, 26), 3])
def test_ratio_is_found_whatever_ratio_was_assumed(assumed, encoder):
    rotor, output = angles(Fraction(-58, 3), 6.0, noise=1e-5)
    if encoder == 'single_turn':
        output = output % TURN
    assert fit_ratio(encoders(rotor, output), GearRatio(assumed)).ratio == Fraction(-58, 3)


def test_exact_angles_have_the_uncertainty_of_their_rounding():
    rotor = np.linspace(0.0, 1000.0, 5000)
    found = estimate_ratio(rotor, rotor * 26.0 / 1457.0)
    assert abs(found.measured.value - 1457.0 / 26.0) <= found.measured.uncertainty < 1e-9
    assert found.ratio == Fraction(1457, 26)


@pytest.mark.parametrize(
    ('rotor', 'output', 'cause'),
    [
        (np.arange(229.0), np.arange(229.0), '229 samples are too few.* at least 230'),
        (np.ones(1000), np.arange(1000.0), 'the rotor does not turn'),
        (np.arange(1000.0), np.zeros(1000), 'the output does not follow the rotor'),
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

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A calibration beside measured errors: what is explained, and when it no longer fits."""

import math

import numpy as np
import pytest
from calibrations import AMPLITUDE, calibration, single_order
from live import SECOND, START

from gear_kinematics.correction.calibration_fit import CalibrationFit, independent_samples
from gear_kinematics.correction.corrector import Corrector
from gear_kinematics.correction.error_window import ErrorWindow
from gear_kinematics.correction.transmission_error import TransmissionError
from gear_kinematics.kinematics import RotorSample, split_turns

PERIOD = 5 * SECOND // 1000  # 200 Hz
COUNT = 2000  # 10 s
WINDOW = 10 * SECOND
ZERO = 0.3  # of the encoder, rad
MADE = single_order()
SPEED = 10.0  # rad/s of the rotor
NOISE = 1e-4 / 1.96  # the normal quantile of 97.5 %, so that the interval is ± 1e-4


def run(errors, made=MADE, speed=SPEED) -> CalibrationFit | None:
    """Turn at a constant speed; errors are measured in the middle between the samples."""
    corrector, window = Corrector(made), ErrorWindow(WINDOW)
    comparison = TransmissionError(max_gap=SECOND, travel=0.01)
    for k, error in enumerate(errors):
        sample = RotorSample(START + k * PERIOD, split_turns(speed * at(k)), 1.0, 0.0)
        deviation, _, half_width, _ = corrector.correct(sample)
        ideal = split_turns(speed * at(k) / -19.0)
        found = comparison.add_ideal(sample.stamp, *ideal, deviation, half_width)
        assert not found
        if k:
            stamp = sample.stamp - PERIOD // 2
            for sample in comparison.add_measured(stamp, speed * at(k - 0.5) / -19.0 + error):
                window.add(sample)
    return window.statistics().calibration


def at(k: float) -> float:
    """Time of a sample, s."""
    return k * PERIOD / SECOND


def measured(rng, amplitude=AMPLITUDE, noise=NOISE):
    """Simulate the error of a gear at those stamps."""
    angles = SPEED * at(np.arange(COUNT) - 0.5)
    return ZERO + amplitude * np.cos(angles) + rng.normal(0.0, noise, COUNT)


def coloured(rng, time_constant: float) -> np.ndarray:
    """Give a first-order Gauss-Markov process of variance 1."""
    decay = math.exp(-PERIOD / SECOND / time_constant)
    values = [rng.normal()]
    for step in rng.normal(0.0, math.sqrt(1 - decay**2), COUNT - 1):
        values.append(decay * values[-1] + step)
    return np.array(values)


@pytest.mark.parametrize('time_constant', [1e-4, 0.1, 1.0, 5.0])
def test_noise_is_not_taken_for_a_bad_fit(time_constant):
    for seed in range(5):
        rng = np.random.default_rng(seed)
        assert run(measured(rng, noise=0.0) + NOISE * coloured(rng, time_constant)).fits


@pytest.mark.parametrize('amplitude', [0.0, 0.5 * AMPLITUDE, AMPLITUDE, 2.0 * AMPLITUDE])
def test_another_gear_does_not_fit(amplitude):
    fit = run(measured(np.random.default_rng(2), amplitude))
    assert fit.samples == COUNT - 1
    assert fit.fits == (amplitude == AMPLITUDE)
    # The variance of a cosine, beside that of the noise; the zero of the encoder does not count.
    left, before = (size**2 / 2 + NOISE**2 for size in (AMPLITUDE - amplitude, amplitude))
    assert fit.explained == pytest.approx(1 - left / before, rel=0.05, abs=0.01)
    if fit.fits:
        assert fit.outside == pytest.approx(0.05, abs=0.015)


def test_standing_output_fits_and_explains_nothing():
    fit = run(np.full(COUNT, ZERO), speed=0.0)
    assert (fit.explained, fit.outside, fit.fits) == (None, 0.0, True)


def test_wide_interval_of_unknown_play_is_respected():
    # The output does not move, so that the play stays unknown: its whole effect is inside.
    errors = ZERO + np.repeat([-7e-4, 7e-4], COUNT // 2)
    assert run(errors, calibration(orders=(), compliance=None), speed=0.0).outside == 0


@pytest.mark.parametrize(
    ('time_constant', 'low', 'high'), [(1e-4, 0.6 * COUNT, 1e5), (0.05, 70, 140), (0.5, 6, 25)]
)
def test_independent_samples_are_those_of_a_gauss_markov_process(time_constant, low, high):
    # The variance of the mean of T seconds is that of T / (2 time constants) samples.
    assert low < at(COUNT) / (2 * time_constant) < high
    rng = np.random.default_rng(6)
    counts = []
    for _ in range(30):
        values = coloured(rng, time_constant)
        counts.append(independent_samples(values - values.mean()))
    assert low < np.median(counts) < high


def test_a_constant_is_no_fault():
    assert independent_samples(np.zeros(50)) == 50.0
    assert independent_samples(np.array([0.0])) == 1.0

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Checks of calibrations on the other half of a recording, and what they refuse."""

import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from calibrating import LIMITED, MECHANISM, halves, recorded
from calibrations import calibration
from gear_recordings import encoders
from simulated_gear import GearSet, gears, simulate, strokes, wandering

from gear_kinematics.correction.calibration_file import Order
from gear_kinematics.correction.calibration_fit import CalibrationFit
from gear_kinematics.measurement.calibration import fit, judge
from gear_kinematics.measurement.recording import Recording, RecordingError


def two_halves(setting, seed, motion=wandering, duration=31.0, *, timed=True):
    random = np.random.default_rng(seed)
    simulated = simulate(setting, gears(setting, random), motion(duration, random), random)
    return [recorded(half, 0, timed=timed) for half in halves(simulated)]


@pytest.mark.slow
@pytest.mark.parametrize('delay', [0.0, 5e-4, 2e-3])
def test_interval_holds_on_the_other_half_whatever_the_delay(delay):
    setting = replace(LIMITED, ratio=100.0, delay=delay)
    coverage = []
    for seed in range(3):
        first, second = two_halves(setting, seed)
        for used, other in ((first, second), (second, first)):
            judged = judge(other, fit([used], Fraction(100)).calibration)
            assert judged.holds
            assert judged.rms_after < judged.rms_before / 4.0
            coverage.append(judged.within_interval)
    assert 0.93 <= np.mean(coverage) <= 0.975
    assert min(coverage) >= 0.92


def test_delay_of_each_recording_is_estimated_like_its_zero():
    delays = {}
    for delay in (0.0, 2e-3):
        first, second = two_halves(replace(GearSet(1), delay=delay), 3, strokes, 40.0)
        calibrated = fit([first], Fraction(-19), MECHANISM)
        delays[delay] = judge(second, calibrated.calibration)
        assert calibrated.delays[0].value == pytest.approx(delay, abs=1.5e-4)
    found = delays[2e-3]
    difference = found.delay.value - delays[0.0].delay.value
    assert difference == pytest.approx(2e-3, abs=1.5e-4)
    assert found.delay.uncertainty < 2e-4
    assert found.holds
    # The delay alone makes 2 ms times the speed.
    speed = np.sqrt(np.mean(second.both.speed(Fraction(-19)) ** 2))
    before, after = found.rms_before_with_delay, found.rms_after_with_delay
    assert after == pytest.approx(np.hypot(found.rms_after, 2e-3 * speed), rel=0.1)
    assert before > found.rms_before
    assert found.rms_after < 0.15 * after


@pytest.mark.parametrize('cycles', [1, 2])
def test_orders_between_fast_samples_are_corrected(cycles):
    """Where its phase changes by up to 2 rad from sample to sample."""
    time, late = np.arange(3000) / 100.0, 4e-3
    order = Order('rotor', Fraction(cycles), 1e-3, 0.0)
    alone = calibration(orders=(order,), constant=0.0, hysteresis=(), compliance=None)

    def ideal(time):
        return 2.0 * np.sin(2.6 * time)

    output = ideal(time - late)
    output = output + 1e-3 * np.cos(cycles * 19.0 * output)
    both = encoders(-19.0 * ideal(time), output, np.round(1e9 * time).astype(np.int64))
    judged = judge(Recording(Path(__file__), 'fast', (), len(time), both), alone)
    assert judged.delay.value == pytest.approx(late, abs=1e-5)
    assert judged.rms_before == pytest.approx(1e-3 / np.sqrt(2.0), rel=0.05)
    assert judged.rms_after < 0.03 * judged.rms_before


def test_without_times_there_is_no_delay():
    first, second = two_halves(GearSet(1), 3, strokes, 30.0, timed=False)
    result = fit([first], Fraction(-19), MECHANISM)
    assert result.delays == [None]
    judged = judge(second, result.calibration)
    assert judged.delay is None
    assert judged.rms_after_with_delay == judged.rms_after
    assert judged.rms_after < 0.3 * judged.rms_before


def test_constant_speed_tells_no_delay():
    random = np.random.default_rng(0)
    setting = GearSet(1, rotor_counts=2**24)
    simulated = simulate(setting, gears(setting, random), np.arange(20_000) * 1e-3, random)
    assert judge(recorded(simulated, 0), calibration()).delay is None


@pytest.mark.parametrize(
    ('assumed', 'true'),
    [
        (-19, 7.29),
        (Fraction(31, 16), -31 / 16),
        (101, 100.0),
        (Fraction(1, 19), 19.0),
        (Fraction(-1, 19), 19.0),
    ],
)
def test_a_wrong_ratio_or_sign_is_named_before_anything_is_fitted(assumed, true):
    recording, _ = two_halves(GearSet(1, ratio=true), 1, strokes, 20.0)
    with pytest.raises(RecordingError) as refused:
        fit([recording], Fraction(assumed))
    message = str(refused.value)
    named = re.fullmatch(
        rf'gear 0: the recorded ratio is (\S+) ± (\S+), not {assumed}[;:,] .*--ratio=.*', message
    )
    measured, uncertainty = map(float, named.groups())
    assert abs(measured - true) <= 2.0 * uncertainty < 0.01 * abs(true)
    if assumed == Fraction(31, 16):
        assert 'an encoder counts backwards, or --ratio=-31/16 is right' in message
    assert ('upside down: give --ratio=19,' in message) is (abs(assumed) < 1)


def checks(half_width, time, runs=100):
    """Judge recordings of 31 s at 1 kHz with errors of variance 1, correlated over a time, ms."""
    random, keep = np.random.default_rng(6), np.exp(-1.0 / time)
    errors = random.standard_normal((31_000, runs))
    errors[1:] *= np.sqrt(1.0 - keep * keep)
    for k in range(1, len(errors)):
        errors[k] += keep * errors[k - 1]
    widths = np.full(len(errors), half_width)
    return [CalibrationFit.of(error, error, widths, once=True) for error in errors.T.copy()]


@pytest.mark.parametrize('time', [20, 100])
def test_88_percent_fail_and_95_percent_pass(time):
    # Quantiles of the normal distribution.
    assert np.mean([found.fits for found in checks(1.55477, time)]) <= 0.05
    assert np.mean([found.fits for found in checks(1.95996, time)]) >= 0.97


@pytest.mark.parametrize('time', [20, 300])
def test_uncertainty_of_the_coverage_is_its_scatter(time):
    found = checks(1.95996, time)
    scatter = np.std([one.outside for one in found])
    # The uncertainty is that of 95 %, which is two standard deviations.
    assert 0.7 < np.median([one.outside_uncertainty for one in found]) / (2.0 * scatter) < 1.5

"""The calibrated output beside a measured angle: what is explained, and when it no longer fits."""

import math

import numpy as np
import pytest
from calibrations import AMPLITUDE, calibration, single_order
from live import SECOND, START

from gear_kinematics.correction.calibrated_output import CalibratedOutput, independent_samples
from gear_kinematics.correction.corrector import Corrector
from gear_kinematics.correction.transmission_error import ErrorSample
from gear_kinematics.kinematics import RotorSample, split_turns

PERIOD = 5 * SECOND // 1000  # 200 Hz
COUNT = 2000  # 10 s
WINDOW = 10.0
ZERO = 0.3  # of the encoder, rad
INPUT = {'segment': 0, 'referenced': True}
MADE = single_order()


def sample(k: int, angle: float) -> RotorSample:
    return RotorSample(START + k * PERIOD, split_turns(angle), 1.0, 0.0)


def run(errors, made=MADE, speed=10.0, start=0) -> CalibratedOutput:
    """Turn at a constant speed; errors are measured in the middle between the samples."""
    output = CalibratedOutput(made)
    follow(output, errors, speed, start)
    return output


def follow(output, errors, speed=10.0, start=0) -> None:
    for k, error in enumerate(errors, start):
        output.correct(sample(k, speed * k * PERIOD / SECOND), **INPUT)
        if k > start:
            stamp = START + k * PERIOD - PERIOD // 2
            output.compare([ErrorSample(stamp, float(error), 0, 0.0, 1, 0.0)])


def measured(rng, amplitude=AMPLITUDE, noise=1e-4 / 1.96, count=COUNT, speed=10.0):
    """Simulate the error of a gear at those stamps; 1.96 is the normal quantile of 97.5 %."""
    angles = speed * (np.arange(count) - 0.5) * PERIOD / SECOND
    return ZERO + amplitude * np.cos(angles) + rng.normal(0.0, noise, count)


def test_correction_is_that_of_the_corrector():
    output, corrector = CalibratedOutput(calibration()), Corrector(calibration())
    for k in range(100):
        one = sample(k, 0.01 * k)
        assert output.correct(one, **INPUT) == corrector.correct(one)


def test_calibration_explains_what_it_predicts_apart_from_the_encoders_zero():
    fit = run(measured(np.random.default_rng(1))).fit(WINDOW)
    assert fit.samples == COUNT - 1
    # The variance of a cosine, beside that of the noise.
    assert fit.explained == pytest.approx(1 - (1e-4 / 1.96) ** 2 / (AMPLITUDE**2 / 2), abs=2e-3)
    assert fit.outside == pytest.approx(0.05, abs=0.015)
    assert fit.fits


def coloured(rng, time_constant: float) -> np.ndarray:
    """Give a first-order Gauss-Markov process of variance 1."""
    decay = math.exp(-PERIOD / SECOND / time_constant)
    values = [rng.normal()]
    for step in rng.normal(0.0, math.sqrt(1 - decay**2), COUNT - 1):
        values.append(decay * values[-1] + step)
    return np.array(values)


@pytest.mark.parametrize('time_constant', [1e-4, 0.1, 1.0, 5.0])
def test_noise_is_not_taken_for_a_bad_fit(time_constant):
    for seed in range(10):
        rng = np.random.default_rng(seed)
        errors = measured(rng, noise=0.0) + 1e-4 / 1.96 * coloured(rng, time_constant)
        assert run(errors).fit(WINDOW).fits


@pytest.mark.parametrize('amplitude', [0.0, 0.5 * AMPLITUDE, 2.0 * AMPLITUDE])
def test_another_gear_does_not_fit(amplitude):
    fit = run(measured(np.random.default_rng(2), amplitude)).fit(WINDOW)
    assert not fit.fits
    left = (AMPLITUDE - amplitude) ** 2 / 2 + (1e-4 / 1.96) ** 2
    before = amplitude**2 / 2 + (1e-4 / 1.96) ** 2
    assert fit.explained == pytest.approx(1 - left / before, rel=0.05, abs=0.01)


def test_standing_output_fits_and_explains_nothing():
    output = run(np.full(COUNT, ZERO), speed=0.0)
    assert output.fit(WINDOW)[1:4] == (None, 0.0, True)


def test_only_the_window_counts():
    rng = np.random.default_rng(3)
    output = run(measured(rng, amplitude=0.0))
    assert not output.fit(WINDOW).fits
    errors = measured(rng, count=2 * COUNT)[COUNT:]
    follow(output, errors, start=COUNT)
    fit = output.fit(0.9 * WINDOW)
    assert fit.fits
    assert fit.samples == round(0.9 * COUNT) + 1


def test_wide_interval_of_unknown_play_is_respected():
    # The output does not move, so that the play stays unknown: its whole effect is inside.
    errors = ZERO + np.repeat([-7e-4, 7e-4], COUNT // 2)
    assert run(errors, calibration(orders=(), compliance=None), speed=0.0).fit(WINDOW).outside == 0


def test_nothing_is_said_without_a_comparison():
    output = CalibratedOutput(MADE)
    assert output.fit(WINDOW) is None
    output.compare([ErrorSample(START, 0.0, 0, 0.0, 1, 0.0)])  # before any sample of the rotor
    output.correct(sample(1, 0.0), **INPUT)
    output.correct(sample(2, 0.0), **INPUT)
    output.compare([ErrorSample(START, 0.0, 0, 0.0, 1, 0.0)])
    assert output.fit(WINDOW) is None


def test_clock_that_is_set_back_begins_anew():
    rng = np.random.default_rng(5)
    output = run(measured(rng, amplitude=0.0))
    follow(output, measured(rng, count=COUNT // 2))
    fit = output.fit(WINDOW)
    assert fit.samples == COUNT // 2 - 1
    assert fit.fits


def test_same_stamp_is_corrected_and_compared_once():
    output = CalibratedOutput(MADE)
    for k in (0, 1, 1, 2):
        output.correct(sample(k, 10.0 * k), **INPUT)
    output.compare([ErrorSample(START + PERIOD, AMPLITUDE, 0, 0.0, 1, 0.0)])
    assert output.fit(WINDOW).samples == 1


def test_homing_makes_the_play_unknown():
    made = calibration(orders=(), compliance=None)
    output = CalibratedOutput(made)
    widths = []
    for k, referenced in enumerate([False, False, True, True]):
        correction = output.correct(sample(k, float(k)), segment=0, referenced=referenced)
        widths.append(correction.half_width)
    unknown = 0.6 * 4e-4 + 0.2 * 2e-3
    assert widths == pytest.approx([1e-4 + unknown, 1e-4, 1e-4 + unknown, 1e-4])


@pytest.mark.parametrize(
    ('time_constant', 'low', 'high'), [(1e-4, 0.6 * COUNT, 1e5), (0.05, 70, 140), (0.5, 6, 25)]
)
def test_independent_samples_are_those_of_a_gauss_markov_process(time_constant, low, high):
    # The variance of the mean of T seconds is that of T / (2 time constants) samples.
    assert low < WINDOW / (2 * time_constant) < high
    rng = np.random.default_rng(6)
    counts = []
    for _ in range(30):
        values = coloured(rng, time_constant)
        counts.append(independent_samples(values - values.mean()))
    assert low < np.median(counts) < high


def test_a_constant_is_no_fault():
    assert independent_samples(np.zeros(50)) == 50.0
    assert independent_samples(np.array([0.0])) == 1.0

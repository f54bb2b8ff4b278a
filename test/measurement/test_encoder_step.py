# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The step of an encoder, from readings that are printed, in single precision, or noisy."""

import math

import numpy as np
import pytest
from simulated_encoders import TURN, sine_strokes, stepped

from gear_kinematics.measurement.encoder_step import Step, find_step, step_of

STEP = TURN / 2**14  # 1.318 arcmin
TIMES = np.arange(8000) / 500.0
NONE = Step(0.0, seen=False)


def single(values):
    return values.astype(np.float32).astype(float)


def printed(template):
    return lambda values: np.array([float(template % value) for value in values.tolist()])


def in_degrees(recorded):
    return lambda values: np.radians(recorded(np.degrees(values)))


RECORDED = {
    'float64': lambda values: values,
    'float32': single,
    'float32 in degrees': in_degrees(single),
    'float32 in an unknown unit': lambda values: 1.2345 * single(values / 1.2345),
    '%.4f': printed('%.4f'),
    '%.6f': printed('%.6f'),
    '%.6g': printed('%.6g'),
    '%.3f in degrees': in_degrees(printed('%.3f')),
    '%.2f in degrees': in_degrees(printed('%.2f')),
    'with an offset': lambda values: values + 1.2345678,
    'backwards': np.negative,
    'within the turn': lambda values: values % TURN,
}


def readings(stroke, noise):
    values = sine_strokes(stroke, 4.0)(TIMES) - 0.3 * stroke
    return values + np.random.default_rng(2).normal(0.0, noise, len(TIMES))


@pytest.mark.parametrize('noise', [0.0, 1e-3], ids=['quiet', 'noisy'])
@pytest.mark.parametrize('recorded', RECORDED)
def test_step_is_found_however_it_was_recorded(recorded, noise):
    found = find_step(RECORDED[recorded](stepped(readings(1.0, noise), STEP)))
    assert found.seen
    assert found.size == pytest.approx(STEP, rel=1e-4)


@pytest.mark.parametrize(('recorded', 'resolution'), [
    ('float32', 2.0**-24), ('float32 in degrees', math.radians(2.0**-18)), ('%.4f', 1e-4),
    ('%.6f', 1e-6), ('%.2f in degrees', math.radians(0.01)),
])  # fmt: skip
def test_resolution_of_the_recording_is_not_a_step_of_the_encoder(recorded, resolution):
    found = find_step(RECORDED[recorded](readings(1.0, 1e-3)))
    assert not found.seen
    assert found.size == pytest.approx(resolution, rel=1e-9)


@pytest.mark.parametrize('decimals', [3, 2])
def test_step_that_the_print_hides_is_not_determinable(decimals):
    found = find_step(np.round(stepped(readings(1.0, 0.0), STEP), decimals))
    assert found == Step(10.0**-decimals, seen=False)


@pytest.mark.parametrize('seed', range(5))
@pytest.mark.parametrize('readings_of', ['noise', 'sine', 'walk'])
def test_readings_without_steps_have_none(seed, readings_of):
    noise = np.random.default_rng(seed).standard_normal(5000)
    values = {
        'noise': noise,
        'sine': np.sin(np.arange(5000) * 0.0123 + seed),
        'walk': np.cumsum(noise),
    }[readings_of]
    assert find_step(values) == NONE


@pytest.mark.parametrize('count', [0, 1, 100])
def test_readings_that_never_change_have_none(count):
    assert find_step(np.full(count, math.pi)) == NONE


def test_even_motion_without_steps_has_none():
    # At an even speed, equal times make equal distances.
    assert find_step(1e-3 * math.sqrt(2.0) * np.arange(2000)) == NONE
    assert find_step(stepped(1e-3 * np.arange(2000), STEP)).size == pytest.approx(STEP)


def test_even_motions_at_several_speeds_have_no_step_of_their_own():
    # All speeds are multiples of 0.36 rad a sample, but for the steps of an encoder.
    speeds = np.repeat([0.7205, 1.0805, 1.4403, -0.7205], 200)
    assert find_step(np.round(stepped(np.cumsum(speeds), TURN / 4096), 5)).size < 0.01


@pytest.mark.parametrize('stray', [9.3, -9999.0])
def test_a_stray_reading_does_not_coarsen_the_step(stray):
    values = stepped(readings(1.0, 0.0), STEP)
    values[300] = stray
    assert 0.0 < find_step(values).size < 1.001 * STEP


@pytest.mark.parametrize('step', [TURN / 65536, TURN / 2**20 / 19, 360 / 4096])
@pytest.mark.parametrize('jump', [1, 7, 90])
def test_levels_may_be_missing(step, jump):
    # The readings move by many steps at a time, and so none are next to each other.
    counts = np.cumsum(np.random.default_rng(4).integers(jump, jump + 3, 3000))
    assert find_step(counts * step) == Step(pytest.approx(step, rel=1e-9), seen=True)
    assert find_step(-(counts * step)) == Step(pytest.approx(step, rel=1e-9), seen=True)


def test_steps_of_a_difference():
    given, found = step_of(4096, np.zeros(0)), Step(3e-3, seen=True)
    assert given == Step(TURN / 4096, seen=False)
    assert Step(4e-3, seen=False).joined(found) == Step(pytest.approx(5e-3), seen=False)
    assert found.scaled(-1 / 3) == Step(pytest.approx(1e-3), seen=True)

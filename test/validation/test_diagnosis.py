# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Causes of deviations, of recorded angles that scatter as those of real encoders."""

import math

import numpy as np
import pytest
from simulated_encoders import ARC_MINUTE, TURN, Drive, sine_strokes

from gear_kinematics.kinematics import Branch, GearRatio, Mechanism
from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.diagnosis import AngleFit, diagnose

TOLERANCE = 1e-9
ERRORS = {1: 4.0 * ARC_MINUTE, 19: ARC_MINUTE}
OURS = Mechanism(80, 76, 1e-3, (Branch('a'),))


def fit(seed=0, batch=1000, change=lambda output: output, assumed=-19.0, noise=2e-3, strokes=6.0):
    """Angles of an encoder whose scatter is some 1e-5 of the variance, in batches."""
    drive = Drive(3.0 * ARC_MINUTE, ERRORS, noise=noise, output_step=TURN / 2**14)
    times, rotor, output = drive.readings(sine_strokes(strokes, 8.0), 20.0, 200.0, seed)
    found, output = AngleFit(), change(output)
    for start in range(0, len(times), batch):
        rows = slice(start, start + batch)
        found.update(rotor[rows], output[rows], output[rows] - rotor[rows] / assumed)
    return found


@pytest.mark.parametrize('batch', [1, 7, 100_000])
@pytest.mark.parametrize(('ring', 'satellite'), [(81, 77), (80, 75), (61, 58)])
def test_ratio_of_angles_that_scatter_is_named(ring, satellite, batch):
    assumed = Mechanism(ring, satellite, 1e-3, (Branch('a'),))
    said = diagnose(assumed, fit(batch=batch, assumed=float(assumed.gear_ratio)), TOLERANCE)
    value, uncertainty = map(float, said.values['ratio'].split(' ± '))
    assert abs(value + 19.0) <= uncertainty < 0.1
    assert said.values['expected'] == str(assumed.gear_ratio)
    assert said.cause == FindingCause.ANOTHER_TOOTH_PAIR


@pytest.mark.parametrize(
    ('gear', 'change', 'cause', 'name', 'true'),
    [
        (GearRatio.parse('-18.5'), np.array, FindingCause.ANOTHER_RATIO, 'ratio', -19.0),
        (OURS, np.negative, FindingCause.SIGN_FLIPPED, 'ratio', 19.0),
        (OURS, lambda output: output + 0.1, FindingCause.MEAN_OFFSET, 'mean', 0.1),
    ],
)
def test_cause_of_angles_that_scatter_is_named(gear, change, cause, name, true):
    said = diagnose(gear, fit(change=change), TOLERANCE)
    assert said.cause == cause
    value, uncertainty = map(float, said.values[name].split(' ± '))
    assert abs(value - true) <= uncertainty < 0.1


@pytest.mark.parametrize('seed', range(5))
def test_angles_that_scatter_alone_have_no_cause(seed):
    assert diagnose(OURS, fit(seed), TOLERANCE) is None


def test_angle_that_steps_has_no_other_ratio():
    def step(output):
        return output + 0.3 * (np.arange(len(output)) > 1700)

    said = diagnose(OURS, fit(change=step), TOLERANCE)
    assert said is None or said.cause == FindingCause.MEAN_OFFSET


@pytest.mark.parametrize('scale', [1.0, 1e200, math.inf, math.nan])
def test_garbage_has_no_cause(scale):
    random = np.random.default_rng(3)
    found = fit(change=lambda output: scale * random.standard_normal(len(output)))
    assert found.slope() is None
    assert diagnose(OURS, found, TOLERANCE) is None


def test_interval_of_the_slope_holds():
    inside = sum(
        abs(found.value + 1.0 / 19.0) <= found.uncertainty
        for found in (fit(seed, noise=3e-3).slope() for seed in range(60))
    )
    # 95 % of 60: fewer than 52 have a probability of less than 1 %.
    assert inside >= 52

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Causes of deviations, of recorded angles that scatter as those of real encoders."""

import math
import re

import numpy as np
import pytest
from simulated_encoders import ARC_MINUTE, TURN, Drive, sine_strokes

from gear_kinematics.kinematics import Branch, GearRatio, Mechanism
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
    value, _, uncertainty, *_ = said.removeprefix('the recorded ratio is ').split()
    assert abs(float(value) + 19.0) <= float(uncertainty.rstrip(','))
    assert float(uncertainty.rstrip(',')) < 0.1
    assert f', not {assumed.gear_ratio}, as that of ring_teeth ' in said


@pytest.mark.parametrize(
    ('gear', 'change', 'begin', 'end'),
    [
        (GearRatio.parse('-18.5'), np.array, 'the recorded ratio is -19.0', ' node'),
        (OURS, np.negative, 'the sign is flipped', ''),
        (OURS, lambda output: output + 0.1, 'the recorded output angle is off by 0.', ' rad'),
    ],
)
def test_cause_of_angles_that_scatter_is_named(gear, change, begin, end):
    said = diagnose(gear, fit(change=change), TOLERANCE)
    assert said.startswith(begin)
    assert said.endswith(end)
    value, uncertainty = re.search(r'([\d.]+) ± ([\d.e-]+)', said).groups()
    assert abs(float(value) - (0.1 if 'off' in said else 19.0)) <= float(uncertainty) < 0.1


@pytest.mark.parametrize('seed', range(5))
def test_angles_that_scatter_alone_have_no_cause(seed):
    assert diagnose(OURS, fit(seed), TOLERANCE) is None


def test_angle_that_steps_has_no_other_ratio():
    def step(output):
        return output + 0.3 * (np.arange(len(output)) > 1700)

    said = diagnose(OURS, fit(change=step), TOLERANCE)
    assert said is None or 'ratio' not in said


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

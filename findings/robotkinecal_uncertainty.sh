#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# robotkinecal 0.1.0: a calibration of an arm by points instead of poses gives a third of the right variance of its
# joints.
#
# A calibration of six joints by 20 measured points of the tool, with a noise of 0.1 mm. Expected of joints_uncertainty,
# which is a variance by the documentation: that of the estimated parameters, as they scatter over many calibrations.
# What happens: the residuals are divided by 6 N minus the number of parameters also where each of the N observations is
# a point of three numbers. For 20 points and 27 parameters that is 93 instead of 33, and the variance is 0.35 of the
# right one, on average. For poses of six numbers it is right. For each joint it is the norm of four variances, two in
# m² and two in rad².
# For us: multiply it by (6 N - p) / (3 N - p), or take the interval of `gearkin calibrate`.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    robotkinecal==0.1.0 roboticstoolbox-python==1.4.4 spatialmath-python==1.1.18 numpy==1.26.4 scipy==1.17.1
cd "$folder"
MPLBACKEND=Agg timeout 200 venv/bin/python -W ignore - <<'PYTHON'
import numpy as np
from robotkinecal import CalibrationResult
from spatialmath import SE3

JOINTS, OBSERVATIONS, NOISE = 6, 20, 1e-4
rng = np.random.default_rng(1)


def told_of_right(numbers):
    """The variance that is told, as a part of the right one, for observations of so many numbers each."""
    parameters = 4 * JOINTS + numbers
    matrix = rng.normal(size=(numbers * OBSERVATIONS, parameters))
    right = NOISE**2 * np.diag(np.linalg.inv(matrix.T @ matrix))
    right = np.linalg.norm(right[:-numbers].reshape(-1, 4), axis=1)
    parts, found = [], []
    for _ in range(300):
        errors = NOISE * rng.normal(size=(numbers * OBSERVATIONS, 1))
        corrections = np.linalg.lstsq(matrix, errors, rcond=None)[0]
        result = CalibrationResult.IterationResult(
            [np.zeros(6)] * JOINTS, SE3(), matrix, corrections, errors, [NOISE] * OBSERVATIONS, [NOISE] * OBSERVATIONS
        )
        parts.append(result.get_statistics()['joints_uncertainty'] / right)
        found.append(corrections.ravel())
    scatter = np.linalg.norm(np.var(found, axis=0)[:-numbers].reshape(-1, 4), axis=1) / right
    part = float(np.mean(parts)), float(np.mean(scatter))
    print(f'{numbers} numbers an observation: told {part[0]:.2f} of the variance, the parameters scatter by {part[1]:.2f} of it')
    return part


told, scatter = told_of_right(6)
assert abs(told - 1) < 0.05 and abs(scatter - 1) < 0.1
told, scatter = told_of_right(3)
assert abs(told - (60 - 27) / (120 - 27)) < 0.05 and abs(scatter - 1) < 0.1
PYTHON

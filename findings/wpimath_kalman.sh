#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# wpimath 2026.2.2: at 200 Hz an encoder with a noise of 0.01 rad is weighted as if it had one of 0.141 rad.
#
# KalmanFilter takes "standard deviations of measurements", and its documentation makes R = 0.0001 of 0.01 in the
# equations of a discrete filter. Expected: the gain of the Riccati equation with this R. What happens: the filter
# divides R by its time step, because it takes the noise as a continuous one. The gain of the position is 0.022 where
# 0.081 is right, and the same encoder is trusted less, the more often it is read.
# For us: multiply the standard deviation of a reading by the square root of the time step, here 0.01 · √0.005 s =
# 0.000707.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check robotpy-wpimath==2026.2.2 numpy==2.4.6 scipy==1.17.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from scipy.linalg import solve_discrete_are
from wpimath.estimator import KalmanFilter_2_1_1
from wpimath.system import LinearSystem_2_1_1

STEP, NOISE, SPEED, ACCELERATION = 0.005, 0.01, 1e-3, 0.1
joint = LinearSystem_2_1_1(np.array([[0.0, 1], [0, 0]]), np.array([[0.0], [1]]), np.array([[1.0, 0]]), np.array([[0.0]]))


def gain_of(noise):
    observer = KalmanFilter_2_1_1(joint, [SPEED, ACCELERATION], [noise], STEP)
    observer.setXhat(np.zeros(2))
    observer.correct(np.zeros(1), np.ones(1))
    return observer.xhat()[0]


def gain_of_riccati(noise):
    a, b = SPEED**2, ACCELERATION**2
    process = np.array([[a * STEP + b * STEP**3 / 3, b * STEP**2 / 2], [b * STEP**2 / 2, b * STEP]])
    step = np.array([[1, STEP], [0, 1]])
    covariance = solve_discrete_are(step.T, np.array([[1.0], [0]]), process, np.array([[noise**2]]))
    return covariance[0, 0] / (covariance[0, 0] + noise**2)


given, right, taken = gain_of(NOISE), gain_of_riccati(NOISE), gain_of_riccati(NOISE / STEP**0.5)
corrected = gain_of(NOISE * STEP**0.5)
print('gain', given, 'of 0.01 rad', right, 'of 0.141 rad', taken, 'with 0.000707 given', corrected)
assert abs(right - 0.0809) < 1e-4
assert abs(given - 0.0221) < 1e-4
assert abs(given - taken) < 1e-9
assert abs(corrected - right) < 1e-9
PYTHON

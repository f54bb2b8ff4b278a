#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# kalmankit 2.0.0: with one Q and one R, its extended Kalman filter estimates a joint at 0 from the second sample on.
#
# A joint turns at 2 rad/s from 1 rad, and its encoder is read 200 times. The documentation of ExtendedKalmanFilter
# calls Q the "Process noise covariance" and R the "Measurement noise covariance", a numpy array or a float. Expected of
# the 2 × 2 matrix Q and the 1 × 1 matrix R: estimates of all 200 angles, up to 4.98 rad. What happens: filter() takes
# their rows for the values of successive samples and stops after the shorter of them, so that the first angle alone is
# estimated, with the first row of Q, and the other 199 angles, speeds and covariances are 0, without an error. With Q
# and R repeated 200 times all is right; with Q alone repeated it is as before.
# For us: give np.array([Q] * len(Z)) and np.array([R] * len(Z)).
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check kalmankit==2.0.0 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from kalmankit import ExtendedKalmanFilter

STEP, SAMPLES = 0.01, 200
TRANSITION = np.array([[1, STEP], [0, 1]])
readings = 1 + 2 * STEP * np.arange(SAMPLES) + np.random.default_rng(1).normal(0, 0.01, SAMPLES)
noise, error = np.diag([1e-8, 1e-6]), np.array([[1e-4]])


def estimated(noise, error):
    joint = ExtendedKalmanFilter(
        xk=np.zeros(2), Pk=np.eye(2), Q=noise, R=error,
        f=lambda state, _: TRANSITION @ state, jacobian_A=lambda state, _: TRANSITION,
        h=lambda state: state[:1], jacobian_H=lambda state: np.array([[1.0, 0.0]]),
    )  # fmt: skip
    states, covariances = joint.filter(readings[:, np.newaxis])
    print('first and last estimates', states[0], states[-1], 'estimated:', np.count_nonzero(states[:, 0]), 'of', len(states))
    return states, covariances


states, _ = estimated(np.array([noise] * SAMPLES), np.array([error] * SAMPLES))
assert np.allclose(states[-1], (1 + 2 * STEP * (SAMPLES - 1), 2), atol=0.03)
for one in ((noise, error), (noise, np.array([1e-4])), (np.array([noise] * SAMPLES), error)):
    states, covariances = estimated(*one)
    assert abs(states[0, 0] - 1) < 0.03 and not states[1:].any() and not covariances[1:].any()
PYTHON

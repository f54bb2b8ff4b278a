#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# filterpy 2.0.0: a Kalman filter of two joints takes the sum of their angles as each encoder's reading.
#
# Expected of kinematic_kf(dim=2, dim_z=2): each of the two measurements is one position. What happens: both rows of H
# measure the sum of both positions, so that joints at 1 and 3 rad are both estimated at 1.0 rad, without a warning. Its
# Q is the identity for every time step, not the white noise of Q_discrete_white_noise, a thousandth of which is meant
# at 1 kHz: the velocity of an encoder at rest is as noisy as a difference of two readings.
# For us: make a filter of dim=1 for each joint, and set its Q.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check filterpy==2.0.0 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from filterpy.common import Q_discrete_white_noise, kinematic_kf

joints = kinematic_kf(dim=2, order=1, dt=0.001, dim_z=2)
for _ in range(2000):
    joints.predict()
    joints.update(np.array([[1.0], [3.0]]))
estimate = joints.x.ravel()[[0, 2]]
print('H', joints.H.tolist(), 'estimate of 1 and 3 rad', estimate)
assert joints.H.tolist() == [[1, 0, 1, 0], [1, 0, 1, 0]]
assert np.allclose(estimate, [1.0, 1.0], atol=0.01)
one = kinematic_kf(dim=1, order=1, dt=0.001)
print('Q', one.Q.tolist(), 'white noise', Q_discrete_white_noise(2, dt=0.001).tolist())
assert np.array_equal(one.Q, np.eye(2))
for _ in range(2000):
    one.predict()
    one.update(np.array([[1.0]]))
assert abs(one.x[0, 0] - 1.0) < 1e-6
PYTHON

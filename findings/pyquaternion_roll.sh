#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pyquaternion 0.9.9: a flange with yaw 60°, pitch 40° and roll 30° is read with 57.0°, 45.3° and -19.3°.
#
# yaw_pitch_roll is documented to give the intrinsic angles z, y', x'', which ROS and URDF call yaw, pitch and roll.
# Expected of a quaternion made of yaw 60°, pitch 40° and roll 30° in this order: these angles. What happens: the
# formulas are those of the order x, y', z'', so that the three angles are those of another convention under the names
# of this one. The documentation gives the matrix of that order, Rx Ry Rz, two lines below the names, and so says both.
# Where only one of the angles is not 0, they are right, so that a test with one rotation passes; with 0.1 rad each the
# error is 10 mrad.
# For us: take the angles from rotation_matrix, as below, or use scipy.spatial.transform.Rotation.as_euler('ZYX').
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pyquaternion==0.9.9 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from pyquaternion import Quaternion


def read(yaw, pitch, roll):
    turn = Quaternion(axis=[0, 0, 1], radians=yaw)
    turn *= Quaternion(axis=[0, 1, 0], radians=pitch) * Quaternion(axis=[1, 0, 0], radians=roll)
    m = turn.rotation_matrix
    right = np.arctan2(m[1, 0], m[0, 0]), -np.arcsin(m[2, 0]), np.arctan2(m[2, 1], m[2, 2])
    assert np.allclose(right, [yaw, pitch, roll])
    order_x_y_z = np.arctan2(-m[0, 1], m[0, 0]), np.arcsin(m[0, 2]), np.arctan2(-m[1, 2], m[2, 2])
    assert np.allclose(turn.yaw_pitch_roll, order_x_y_z)
    return np.array(turn.yaw_pitch_roll)


large = np.degrees(read(*np.radians([60, 40, 30])))
print('yaw, pitch and roll of 60°, 40° and 30° are read as', large)
assert np.allclose(large, [57.0, 45.3, -19.3], atol=0.1)
error = np.abs(read(0.1, 0.1, 0.1) - 0.1).max()
print('greatest error with 0.1 rad each', error)
assert abs(error - 0.0099) < 1e-4
for single in np.radians([60, 0, 0]), np.radians([0, 40, 0]), np.radians([0, 0, 30]):
    assert np.allclose(read(*single), single)
PYTHON

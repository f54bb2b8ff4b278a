#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mcap-data-loader 0.3.5: a flange that turned by 30° about z is, through its rotation of six numbers, turned by 59°.
#
# The poses of an arm in a recording, relative to the first one. Expected: what to_relative_pose_serial() gives as six
# numbers, rot6d_to_matrix() of the same module takes back. What happens: the first one lists the two columns of the
# matrix row by row, the second one takes the first three numbers as the first column, as Rotation6D does in both
# directions. So each rotation comes back as another one, and that of the first pose, which is none, as NaN or as a
# matrix that is no rotation. The quaternions of the same function are right, and so is Rotation6D.quat_to_rot6d().
# For us: gearkin reads the joints of a recording, not its poses. Store quaternions.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    mcap-data-loader==0.3.5 numpy==2.4.6 scipy==1.17.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from mcap_data_loader.utils.rela_abs import rot6d_to_matrix, to_relative_pose_serial
from mcap_data_loader.utils.rot6d import Rotation6D
from scipy.spatial.transform import Rotation


def degrees(matrix):
    return round(float(np.degrees(np.linalg.norm(Rotation.from_matrix(matrix).as_rotvec()))), 1)


angles = np.radians([0, 30, 60])
quaternions = np.stack([0 * angles, 0 * angles, np.sin(angles / 2), np.cos(angles / 2)], axis=1)
_, relative, numbers = to_relative_pose_serial(np.zeros((3, 3)), quaternions)
right = [degrees(Rotation.from_quat(quaternion).as_matrix()) for quaternion in relative]
round_trip = [degrees(Rotation6D.rot6d_to_matrix(Rotation6D.quat_to_rot6d(quaternion))) for quaternion in relative]
with np.errstate(invalid='ignore'):
    back = rot6d_to_matrix(numbers)
wrong = [degrees(matrix) for matrix in back[1:]]
still = Rotation6D.rot6d_to_matrix(numbers[0])
print('quaternions', right, 'six numbers', wrong, 'of no rotation', back[0].tolist(), still.tolist())
assert right == round_trip == [0.0, 30.0, 60.0]
assert wrong == [59.0, 79.9]
assert np.isnan(back[0]).any() and abs(np.linalg.det(still)) < 1e-9
PYTHON

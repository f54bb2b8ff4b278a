#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# ahrs 0.4.0: DCM and Quaternion make different rotations of the same roll, pitch and yaw.
#
# Quaternion(rpy=[0.1, 0.2, 0.3]) rolls by 0.1 about x, pitches by 0.2 about y and yaws by 0.3 about z, as a URDF does.
# DCM(rpy=[0.1, 0.2, 0.3]) turns by 0.1 about z and by 0.3 about x: it takes the angles in the opposite order.
# Seen beside scipy 1.17.1, whose Rotation.from_euler('xyz', ...) is that of a URDF.
# For us: make the matrix of a URDF's origin by Quaternion(rpy=...).to_DCM().
#
# Exit code 0: still so. Installs the packages into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check ahrs==0.4.0 scipy==1.17.1
"$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from ahrs import DCM, Quaternion
from scipy.spatial.transform import Rotation

angles = [0.1, 0.2, 0.3]
quaternion = np.asarray(Quaternion(rpy=angles).to_DCM())
matrix = np.asarray(DCM(rpy=angles))
apart = Rotation.from_matrix(quaternion.T @ matrix).magnitude()
print(f'DCM and Quaternion are {apart:.4f} rad apart')
assert np.allclose(quaternion, Rotation.from_euler('xyz', angles).as_matrix())
assert np.allclose(matrix, Rotation.from_euler('xyz', angles[::-1]).as_matrix())
assert apart > 0.28
PYTHON

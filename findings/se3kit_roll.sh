#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# se3kit 1.0.6: a roll of 0.3 rad about turned axes is read back as -0.3 rad, and the axis of a rotation of 0.01 µrad is
# an error.
#
# Rotation.from_rpy([0.3, 0.4, 0.5], extrinsic=False) makes the right matrix. Expected of as_rpy(extrinsic=False), or of
# as_xyz(): the same angles. What happens: [-0.3, 0.4, 0.5], and by as_zyx(extrinsic=True) alike, since an element of
# the matrix that is -sin(roll) is taken for sin(roll). The defaults, as_rpy() about fixed axes and as_zyx(), are right.
# Expected of as_axisangle() of a flange that stands still: an angle of about 0. What happens: at 0.1 µrad the axis has
# a length of 1.012, and at 0.01 µrad it raises a ValueError.
# For us: negate the roll of as_xyz(), or take the angles from SciPy, and the angle between two poses from
# angle_difference().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check se3kit==1.0.6 numpy==2.4.6 \
    numpy-quaternion==2024.0.13 scipy==1.17.1
cd "$folder"
timeout 60 venv/bin/python -W ignore - <<'PYTHON'
import numpy as np
import scipy.spatial.transform
from se3kit.rotation import Rotation

ANGLES = [0.3, 0.4, 0.5]
turned = Rotation.from_rpy(ANGLES, extrinsic=False)
right = scipy.spatial.transform.Rotation.from_matrix(turned.m).as_euler('XYZ')
print('SciPy', right, 'as_rpy', turned.as_rpy(extrinsic=False), 'as_xyz', turned.as_xyz())
assert np.allclose(right, ANGLES)
for read in (turned.as_rpy(extrinsic=False), turned.as_xyz()):
    assert np.allclose(read, [-0.3, 0.4, 0.5])
reversed_order = Rotation.from_zyx(ANGLES, extrinsic=True).as_zyx(extrinsic=True)
print('as_zyx about fixed axes', reversed_order)
assert np.allclose(reversed_order, [0.3, 0.4, -0.5])
assert np.allclose(Rotation.from_rpy(ANGLES).as_rpy(), ANGLES)
assert np.allclose(Rotation.from_zyx(ANGLES).as_zyx(), ANGLES)
axis, angle = Rotation.rotate_z(1e-7).as_axisangle()
print('axis of 0.1 µrad', axis, angle)
assert np.linalg.norm(axis) > 1.01
try:
    Rotation.rotate_z(1e-8).as_axisangle()
except ValueError as error:
    print('axis of 0.01 µrad:', error)
else:
    raise SystemExit(1)
PYTHON

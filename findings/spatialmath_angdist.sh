#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# spatialmath-python 1.1.18: the angle between two rotations is half as large between quaternions.
#
# Two joints that stand 0.2832 rad apart: SO3.angdist() gives 0.2832, UnitQuaternion.angdist() 0.1416. Both are said to
# be the angle in radians. The default of the one is its metric 6, that of the other its metric 3, the angle between
# the quaternions in four dimensions; metrics 1 to 3 are half the angle in both classes.
# For us: compare measured and ideal poses by SO3, or by metric=4 of UnitQuaternion.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check spatialmath-python==1.1.18
"$folder/venv/bin/python" - <<'PYTHON'
from spatialmath import SO3, UnitQuaternion

matrices = SO3.Rz(3.0).angdist(SO3.Rz(2.7168))
quaternions = UnitQuaternion.Rz(3.0).angdist(UnitQuaternion.Rz(2.7168))
other = UnitQuaternion.Rz(3.0).angdist(UnitQuaternion.Rz(2.7168), metric=4)
print('SO3', matrices, 'UnitQuaternion', quaternions, 'with metric 4', other)
for angle, expected in ((matrices, 0.2832), (quaternions, 0.1416), (other, 0.2832)):
    assert abs(angle - expected) < 1e-6
PYTHON

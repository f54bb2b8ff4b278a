#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# basic-robotics 1.0.2: a linear axis of a URDF turns instead of sliding, and half way between 0° and 90° is 54°.
#
# loadArmFromURDF() of an arm whose first joint is prismatic along x. Expected of FK([0.5, 0]): a shift by 0.5 m. What
# happens: a rotation by 0.5 rad about x, as each joint that is not fixed is taken as revolute, without an error.
# Expected of tmInterpMidpoint(), whose rotation is documented to be "a proper interpolation": 45° between 0° and 90°.
# What happens: 53.95°, 7.8° instead of 5.7° between 0° and 11.5°, and 0° between 0° and 180°, since the matrix is
# halved instead of its logarithm. Expected of mirror() at the plane z = 1 m: a point at z = 3 m comes to -1 m. What
# happens: it comes to -5 m; at z = 0 it is right.
# For us: take the kinematics of an arm with a linear axis from another library, and interpolate poses by SciPy's Slerp.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check basic-robotics==1.0.2 numpy==1.26.4 scipy==1.17.1
cd "$folder"
cat > slide.urdf <<'URDF'
<robot name="slide"><link name="base"/>
  <link name="slide"><inertial><origin xyz="0 0 0"/><mass value="1"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="arm"><inertial><origin xyz="0 0 0"/><mass value="1"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="axis" type="prismatic"><origin xyz="0 0 0.2"/><parent link="base"/><child link="slide"/>
    <axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="10" velocity="2"/></joint>
  <joint name="elbow" type="revolute"><origin xyz="0 0 0.3"/><parent link="slide"/><child link="arm"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="10" velocity="2"/></joint>
</robot>
URDF
timeout 200 venv/bin/python -W ignore - <<'PYTHON'
from math import cos, degrees, isclose, radians, sin

import numpy as np
from basic_robotics.general import fsr, tm
from basic_robotics.kinematics import loadArmFromURDF

arm = loadArmFromURDF('slide.urdf')
home, moved = (arm.FK(np.array([slide, 0.0])).TM for slide in (0.0, 0.5))
print('an axis at 0.5 m moves the flange to', moved[:3, 3], 'and turns it by', np.arctan2(moved[2, 1], moved[1, 1]), 'rad')
assert np.allclose(home[:3, 3], [0, 0, 0.5]) and np.allclose(home[:3, :3], np.eye(3))
assert np.allclose(moved[:3, 3], [0, -0.3 * sin(0.5), 0.2 + 0.3 * cos(0.5)])
assert isclose(np.arctan2(moved[2, 1], moved[1, 1]), 0.5)
for end, expected in ((11.459, 7.788), (90, 53.952), (180, 0)):
    middle = fsr.tmInterpMidpoint(tm(), tm([0, 0, 0, 0, 0, radians(end)]))
    print(f'half way between 0° and {end}°: {degrees(middle[5]):.2f}°')
    assert isclose(degrees(middle[5]), expected, abs_tol=0.01)
for plane, expected in ((0.0, -3.0), (1.0, -5.0)):
    mirrored = fsr.mirror(tm([0, 0, plane, 0, 0, 0]), tm([0.2, 0.3, 3, 0, 0, 0]))
    print(f'z = 3 m mirrored at z = {plane} m: {mirrored[2]:.2f} m')
    assert isclose(mirrored[2], expected)
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# urchin 0.0.30: a joint that mimics a joint that itself mimics stands still at 0.
#
# A motor drives an output by -0.05, and a pointer follows the output by 2 with an offset of 0.2. At 4.0 of the motor
# the output is at -0.2, and the pointer should be at -0.2. link_fk() places it at 0, without its offset, and
# says nothing. yourdfpy 0.0.60 places it at its offset and warns; scikit-robot 0.4.7 is right.
# For us: let every joint mimic the motor itself, with the product of the ratios.
#
# Exit code 0: still so. Installs the packages into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check urchin==0.0.30 scikit-robot==0.4.7 yourdfpy==0.0.60
cd "$folder"
cat > gear.urdf <<'URDF'
<robot name="gear">
  <link name="stator"/><link name="rotor"/><link name="shaft"/><link name="hand"/>
  <joint name="motor" type="continuous"><parent link="stator"/><child link="rotor"/><axis xyz="0 0 1"/></joint>
  <joint name="output" type="continuous"><parent link="stator"/><child link="shaft"/><axis xyz="0 0 1"/>
    <mimic joint="motor" multiplier="-0.05"/></joint>
  <joint name="pointer" type="continuous"><parent link="shaft"/><child link="hand"/><axis xyz="0 0 1"/>
    <mimic joint="output" multiplier="2" offset="0.2"/></joint>
</robot>
URDF
venv/bin/python - <<'PYTHON'
import math

import skrobot
import urchin
import yourdfpy


def angle(shaft, hand):
    return math.atan2(hand[1][0], hand[0][0]) - math.atan2(shaft[1][0], shaft[0][0])


placed = urchin.URDF.load('gear.urdf').link_fk({'motor': 4.0}, use_names=True)
by_urchin = angle(placed['shaft'], placed['hand'])
model = yourdfpy.URDF.load('gear.urdf')
model.update_cfg({'motor': 4.0})
by_yourdfpy = angle(model.get_transform('shaft'), model.get_transform('hand'))
robot = skrobot.models.urdf.RobotModelFromURDF(urdf_file='gear.urdf')
robot.motor.joint_angle(4.0)
by_skrobot = angle(robot.shaft.worldrot(), robot.hand.worldrot())
print('urchin', by_urchin, 'yourdfpy', by_yourdfpy, 'scikit-robot', by_skrobot)
assert abs(math.atan2(placed['shaft'][1][0], placed['shaft'][0][0]) + 0.2) < 1e-9
for measured, expected in ((by_urchin, 0.0), (by_yourdfpy, 0.2), (by_skrobot, -0.2)):
    assert abs(measured - expected) < 1e-6
PYTHON

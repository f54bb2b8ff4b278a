#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# robodk 6.0.2: a flange that points straight down at 30° is given to Catia at -30°, one that is sent to a Nachi robot
# is read back 54° away, and a third joint at 30° that depends on the second comes back at 70°.
#
# Expected of the conversions in robodk.robomath: Pose_2_Catia() returns angles a, b and c with rotz(a) rotx(b) rotz(c)
# equal to the pose, as documented; Nachi_2_Pose() undoes Pose_2_Nachi(), as each other pair of formats does;
# angles_2_joints() undoes joints_2_angles() for a type of robot, and both leave the list that they get as it is.
# What happens: Pose_2_Catia() has the wrong sign of c where the z axis points straight down, and is right beside it.
# Pose_2_Nachi() gives the angles as yaw, pitch and roll, and Nachi_2_Pose() takes them as roll, pitch and yaw. Of type
# 4, whose third joint is turned with the second one, angles_2_joints() changes nothing; types 2, 3 and 11 come back
# right. joints_2_angles() changes the list of joints itself. No exception says so.
# Output: Catia: 0, 180 and -30, 60° off; beside it 0° off
#         Nachi: 60, 40 and 30, read back 54° off; Fanuc, KUKA and Staubli 0° off
#         joints [10, 40, 30] of type 4 become [10, 40, 70] and come back as [10, 40, 70]
# For us: turn the angles about for a Nachi robot, and give joints_2_angles() a copy and its inverse yourself.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps robodk==6.0.2
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
from math import degrees, radians

from robodk import robomath
from robodk.robomath import pose_angle_between, rotx, roty, rotz, transl


def off(pose, other):
    return round(degrees(pose_angle_between(pose, other)), 3)


def catia(pose):
    a, b, c = (radians(angle) for angle in robomath.Pose_2_Catia(pose)[3:])
    return off(pose, rotz(a) * rotx(b) * rotz(c))


down = rotx(radians(180)) * rotz(radians(30))
beside = rotx(radians(179)) * rotz(radians(30))
angles = [round(angle) for angle in robomath.Pose_2_Catia(down)[3:]]
print('Catia:', *angles, 'off by', catia(down), 'beside it by', catia(beside))
assert angles == [0, 180, -30] and catia(down) == 60 and catia(beside) == 0

pose = transl(1, 2, 3) * rotz(radians(60)) * roty(radians(40)) * rotx(radians(30))
errors = {}
for name in ('Nachi', 'Fanuc', 'KUKA', 'Staubli', 'Motoman', 'UR', 'Adept'):
    values = getattr(robomath, f'Pose_2_{name}')(pose)
    errors[name] = off(pose, getattr(robomath, f'{name}_2_Pose')(values))
print('Nachi:', [round(value) for value in robomath.Pose_2_Nachi(pose)], 'off by', errors)
assert round(errors.pop('Nachi')) == 54 and set(errors.values()) == {0}

for kind, right in ((2, True), (3, True), (4, False), (11, True)):
    joints = [10, 40, 30, 1, 2, 3]
    turned = list(robomath.joints_2_angles(joints, kind))
    back = robomath.angles_2_joints(list(turned), kind)
    print('type', kind, 'becomes', turned, 'and comes back as', back, 'given list', joints)
    assert (back == [10, 40, 30, 1, 2, 3]) == right and joints == turned
assert robomath.joints_2_angles([10, 40, 30, 1, 2, 3], 4)[2] == 70
assert robomath.angles_2_joints([10, 40, 70, 1, 2, 3], 4)[2] == 70
PYTHON

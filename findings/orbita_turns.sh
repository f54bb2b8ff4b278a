#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# orbita 0.3.1: of a platform that turns on beyond 420°, one of the three disks is sent back by a whole turn.
#
# Expected of get_angles_from_quaternion(), which keeps the last angles to find the turns of the disks: about its
# vertical axis the platform turns with all three disks, as by get_angles_from_vector(), which goes on for two turns.
# What happens: only one turn is added to an angle within ±180°. At a yaw of 430° the second disk is sent from 420° to
# 70°, at 550° the first from 540° to 190°, and at 670° the third from 660° to 310°, while the others go on: the
# platform is twisted. Backward the same happens from -430° on.
# For us: unwrap the yaw yourself, and call get_angles_from_vector().
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check orbita==0.3.1 numpy==2.3.5 pyquaternion==0.9.9
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from orbita import Actuator
from pyquaternion import Quaternion

by_quaternion, by_vector = Actuator(), Actuator()
jumps, before = [], [0, 0, 0]
for yaw in range(0, 720, 10):
    q = Quaternion(axis=[0, 0, 1], degrees=yaw)
    disks = [round(float(angle), 6) for angle in by_quaternion.get_angles_from_quaternion(q.w, q.x, q.y, q.z)]
    wrapped = (yaw + 180) % 360 - 180
    assert all(abs(angle - yaw) < 1e-6 for angle in by_vector.get_angles_from_vector([0, 0, 1], wrapped))
    jumps += [(yaw, disk + 1, before[disk], disks[disk]) for disk in range(3) if abs(disks[disk] - before[disk]) > 11]
    before = disks
for yaw, disk, last, now in jumps:
    print(f'at a yaw of {yaw}° the disk {disk} is sent from {last:.0f}° to {now:.0f}°')
assert jumps == [(430, 2, 420, 70), (550, 1, 540, 190), (670, 3, 660, 310)]
back = Actuator()
for yaw in range(0, -440, -10):
    q = Quaternion(axis=[0, 0, 1], degrees=yaw)
    disks = back.get_angles_from_quaternion(q.w, q.x, q.y, q.z)
print('at a yaw of -430°:', [round(float(angle)) for angle in disks])
assert sorted(round(float(angle)) for angle in disks) == [-430, -430, -70]
PYTHON

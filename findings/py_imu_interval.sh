#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# py-imu 0.1.0: an arm that turned by 1 rad at a given rate of 100 Hz is at 0 rad, and a tilted one that heads to 240°
# at 272°.
#
# Expected of Madgwick(frequency=100.0), with exact readings of an arm that turns about the vertical at 0.5 rad/s for 2
# s: 1 rad, as for dt=0.01, which is "not required". What happens: 0 rad, as each update() without its own dt begins
# anew with the pose that the accelerometer shows; the rates of turning and the frequency have no effect. Expected of
# rpymag2h(), a "tilt compensated heading", for an arm with a roll of 40°, a pitch of -30° and a yaw of 240°, whose
# magnetometer reads a field of north and down: 240°, as accelmag2rpy() of the same readings gives. What happens:
# 272.3°, as roll and pitch are taken in the opposite order. With a roll or a pitch alone both are right.
# For us: give dt to each update(), as its readme does, take the heading of accelmag2rpy(), and check a known turn.
#
# Exit code 0: still so. Installs the versions into a temporary folder. Needs Python 3.11 or 3.12.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check py-imu==0.1.0 numpy==2.4.6
cd "$folder"
export LOGURU_LEVEL=WARNING
timeout 60 venv/bin/python - <<'PYTHON'
import numpy as np
from py_imu.fusion.madgwick import Madgwick
from py_imu.fusion.quaternion import Vector3D
from py_imu.fusion.utilities import accelmag2rpy, q2rpy, rpymag2h

at_rate, at_steps = Madgwick(frequency=100.0), Madgwick(frequency=100.0)
for _ in range(201):
    turning, gravity = Vector3D(0.0, 0.0, 0.5), Vector3D(0.0, 0.0, 9.81)
    at_rate.update(gyr=turning, acc=gravity)
    at_steps.update(gyr=turning, acc=gravity, dt=0.01)
yaws = q2rpy(at_rate.q).z, q2rpy(at_steps.q).z
print('after 2 s at 0.5 rad/s:', yaws[0], 'rad with a frequency,', yaws[1], 'rad with dt')
assert yaws[0] == 0 and abs(yaws[1] - 1.0) < 0.01


def headings(roll, pitch, yaw):
    """The headings in ° of both functions for an arm whose axes are forward, right and down."""
    (cr, sr), (cp, sp), (cy, sy) = ((np.cos(angle), np.sin(angle)) for angle in np.radians([roll, pitch, yaw]))
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    turned = about_z @ about_y @ about_x
    down, field = turned.T @ [0, 0, 1], turned.T @ [20, 0, 44]
    pose = accelmag2rpy(Vector3D(*down), Vector3D(*field))
    return np.degrees([pose.z, rpymag2h(pose, Vector3D(*field)), pose.x, pose.y])


for roll, pitch in ((20, 0), (0, 30)):
    assert np.allclose(headings(roll, pitch, 60), [60, 60, roll, pitch])
both = headings(40, -30, 240)
print('roll 40°, pitch -30°, yaw 240°: accelmag2rpy', both[0], '°, rpymag2h', both[1], '°')
assert np.allclose(both[[0, 2, 3]], [-120, 40, -30]) and abs(both[1] - 272.3) < 0.1
PYTHON

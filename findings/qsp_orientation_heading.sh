#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# qsp-orientation 0.1.1: an arm that rests at 90° is at 1.6° after 2 s, and a magnetometer tilts a level arm by 33°.
#
# Its filters estimate the attitude of an arm from an IMU; each step is documented with its units. An arm rests level.
# Expected: it stays where it is. What happens, at 100 Hz: complementary_filter() with alpha = 0.98 turns it from 90° to
# 33° in 0.5 s and to 1.6° in 2 s without any rate, as it blends with an attitude of the accelerometer whose heading is
# always 0. mahony_update() takes the y axis as north where madgwick_update() takes the x axis, so that a heading of 40°
# is 130° in a horizontal field; and it takes the field as horizontal: in one that dips by 65°, as in Europe, the level
# arm is tilted by 33°. Without a magnetometer, and in madgwick_update(), all is right. None of this is a warning.
# For us: use the AHRS library, or madgwick_update().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check qsp-orientation==0.1.1 numpy==2.4.6
timeout 200 "$folder/venv/bin/python" -W error - <<'PYTHON'
import math

import numpy as np
from qsp.orientation import (
    complementary_filter,
    euler_to_quaternion,
    integrate_gyro,
    madgwick_update,
    mahony_update,
    quaternion_to_euler,
    quaternion_to_rotation_matrix,
    world_to_body,
)

STEP, STILL, DOWN = 0.01, np.zeros(3), np.array([0, 0, 9.81])


def heading(quaternion):
    return math.degrees(quaternion_to_euler(quaternion)[2])


def tilt(quaternion):
    return math.degrees(math.acos(quaternion_to_rotation_matrix(quaternion)[2, 2]))


arm = euler_to_quaternion(0, 0, math.radians(90))
headings = []
for _ in range(201):
    headings.append(heading(arm))
    arm = complementary_filter(integrate_gyro(arm, STILL, STEP), DOWN, 0.98)
print('complementary_filter() after 0, 0.5 and 2 s:', np.round([headings[0], headings[50], headings[200]], 1), '°')
assert abs(headings[50] - 32.8) < 0.1 and abs(headings[200] - 1.6) < 0.1

START = euler_to_quaternion(0, 0, math.radians(40))
for dip, mahony_heading, mahony_tilt in ((0, 130, 0), (65, None, 33)):
    earth = np.array([math.cos(math.radians(dip)), 0, -math.sin(math.radians(dip))])
    field = world_to_body(START, earth)
    madgwick, mahony, inertial, integral = START, START, START, None
    for _ in range(6000):
        madgwick = madgwick_update(madgwick, STILL, DOWN, 0.1, STEP, mag=field)
        mahony, integral = mahony_update(mahony, STILL, DOWN, dt=STEP, integral_error=integral, mag=field)
        inertial, _ = mahony_update(inertial, STILL, DOWN, dt=STEP)
    for name, result in (('madgwick_update()', madgwick), ('mahony_update()', mahony), ('without field', inertial)):
        print(f'{name}, field dips by {dip}°: heading {heading(result):.1f}°, tilt {tilt(result):.1f}°')
    for result in (madgwick, inertial):
        assert abs(heading(result) - 40) < 0.1 and tilt(result) < 0.1
    assert abs(tilt(mahony) - mahony_tilt) < 1
    assert mahony_heading is None or abs(heading(mahony) - mahony_heading) < 1
PYTHON

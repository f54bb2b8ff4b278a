#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# squaternion 2025.3.2: a turn by 90° about the axis (1, 1, 0) is one by 109.5°, and about (0, 0, 2) one by 126.9°.
#
# Quaternion.from_angle_axis() takes an angle and an axis, as a joint of a URDF has it, whose axis need not have the length 1.
# Expected: the angle, or an error. What happens: the vector of the quaternion is made longer by the length of the axis, and
# the whole is normalized then, which changes the angle. The result is a unit quaternion, so no check finds it: 10° about
# (0, 0, 2) are 19.9°, 180° are right, and 90° about an axis of 0.5 are 53.1°. With a length of 1, all are right.
# For us: normalize the axis before.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check squaternion==2025.3.2
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import math

from squaternion import Quaternion

CASES = (
    (90, (0, 0, 1), 90.0),
    (90, (1, 1, 0), 109.47),
    (90, (0, 0, 2), 126.87),
    (90, (0, 0, 0.5), 53.13),
    (10, (0, 0, 2), 19.85),
    (180, (0, 0, 2), 180.0),
)
for degrees, axis, expected in CASES:
    turn = Quaternion.from_angle_axis(degrees, axis, degrees=True)
    found = math.degrees(turn.angle)
    print(degrees, '° about', axis, 'are', found, '°, length of the quaternion', turn.magnitude)
    assert abs(found - expected) < 0.01
    assert abs(turn.magnitude - 1) < 1e-12
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# yostlabs-math 2026.3.11: nine tenths of the way from 0° to 20° are at 12.1° if the goal's quaternion has w < 0, and
# half way between two equal poses is an error.
#
# slerp() of the maker of the 3-Space sensors of orientation. Expected: 18° at 0.9 of the way from 0° to 20°, whichever
# of the two quaternions of the goal is given. What happens: 18.0° by the one, 12.1° by the other, as the angle is still
# that of the way round; and 2.26° instead of 2° at a tenth of the way, as sin((1 - t) theta) is calculated as sin(1 -
# t) theta. From 0° to 170°, a quarter of the way is 4.3° off. Between two equal quaternions, it raises a
# ZeroDivisionError.
# For us: interpolate the poses of a recording by SciPy's Slerp.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check yostlabs-math==2026.3.11
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
from math import atan2, degrees, hypot, radians

from yostlabs.math.quaternion import quat_from_axis_angle, slerp

START = [0, 0, 0, 1]


def reached(goal_deg, sign, part):
    goal = [sign * value for value in quat_from_axis_angle([0, 0, 1], radians(goal_deg))]
    x, y, z, w = slerp(START, goal, part)
    angle = 2 * degrees(atan2(hypot(x, y, z), w))
    print(f'{part} of the way to {goal_deg}°, w {"≥" if sign > 0 else "<"} 0: {angle:.2f}° instead of {part * goal_deg:.2f}°')
    return angle


assert abs(reached(20, 1, 0.1) - 2.256) < 0.001
assert abs(reached(20, 1, 0.9) - 18.003) < 0.001
assert abs(reached(20, -1, 0.9) - 12.108) < 0.001
assert abs(reached(20, -1, 0.5) - 8.233) < 0.001
assert abs(reached(170, 1, 0.25) - 38.195) < 0.001
try:
    slerp(START, START, 0.5)
except ZeroDivisionError as error:
    print('between two equal quaternions:', error)
else:
    raise SystemExit(1)
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# wpimath 2026.2.2: a joint under a load of 5 N·m stays 0.4 rad from its goal, although its controller has an integral term.
#
# A PIDController with kP = 10, kI = 10 and kD = 5 in N·m holds a joint. Expected: its integral grows until the joint is at
# its goal. What happens: the integral term stops at 1.0, whatever the unit of the output, as its range is [-1, 1] until
# setIntegratorRange() is called; the other 4 N·m need an error of 0.4 rad. With a range of [-10, 10] the error vanishes.
# For us: set the range of the integral in the unit of the output.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check robotpy-wpimath==2026.2.2
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from wpimath.controller import PIDController

STEP, LOAD, GOAL = 0.005, 5.0, 1.0


def error_after_a_minute(greatest=None):
    controller = PIDController(10, 10, 5, STEP)
    if greatest:
        controller.setIntegratorRange(-greatest, greatest)
    angle, speed = 0.0, 0.0
    for _ in range(round(60 / STEP)):
        speed += (controller.calculate(angle, GOAL) - LOAD) * STEP
        angle += speed * STEP
    return GOAL - angle


errors = error_after_a_minute(), error_after_a_minute(10)
print('error of the joint', errors[0], 'rad, with a range of 10 N·m', errors[1], 'rad')
assert abs(errors[0] - 0.4) < 1e-6
assert abs(errors[1]) < 1e-6
PYTHON

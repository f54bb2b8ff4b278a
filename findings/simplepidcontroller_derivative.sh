#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# simplepidcontroller 1.0.0: a derivative gain of 5 acts as 0.25, and a joint overshoots by 96 % instead of 44 %.
#
# A joint of 1 kg·m² is held by a gain of 100 N·m/rad and damped by 5 N·m·s/rad. Expected: the derivative gain times
# the change of the error. What happens: the change is multiplied by the derivative time of 0.05 s twice, so that only
# 0.25 N·m·s/rad act. The same holds for ideal_constants. A joint that is sent from 0 to 1 rad goes to 1.96 rad, where
# 1.44 rad are right.
# For us: give the square root of the derivative time, T, to ideal_constants: sqrt(0.05).
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check simplepidcontroller==1.0.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from math import sqrt

from simplepidcontroller import PID

STEP = 1e-4


def overshoot(torque_of):
    position, speed, greatest = 0.0, 0.0, 0.0
    for _ in range(20000):
        speed += torque_of(position) * STEP
        position += speed * STEP
        greatest = max(greatest, position)
    return greatest - 1


def controlled(constants):
    controller = PID(1.0)
    controller.ideal_constants = constants
    controller.compute(0.0, STEP)  # the first derivative is that of an error of 0 before
    return overshoot(lambda position: controller.compute(position, STEP))


def textbook(derivative):
    previous = [1.0]

    def torque(position):
        change, previous[0] = 1 - position - previous[0], 1 - position
        return 100 * (1 - position) + derivative * change / STEP

    return overshoot(torque)


controller = PID(0.0)
controller.parallel_constants = 100.0, 1e-9, 5.0
controller.compute(0.0, 0.01)
controller.compute(0.01, 0.01)
print('derivative part at -1 rad/s', controller.history['derivatives'][1], 'right', -5.0)
assert abs(controller.history['derivatives'][1] + 0.25) < 1e-9
given, corrected = controlled((100.0, 1e9, 0.05)), controlled((100.0, 1e9, sqrt(0.05)))
right, taken = textbook(5), textbook(0.25)
print('overshoot', given, 'right', right, 'with a derivative gain of 0.25', taken, 'with the square root', corrected)
assert abs(given - taken) < 1e-3 and abs(corrected - right) < 1e-3 and given > 0.9 and right < 0.5
PYTHON

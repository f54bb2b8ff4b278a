#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# wpimath 2026.2.2: for a joint that stands still 1 rad from its goal, a derivative gain of 1 gives -50 at first, not 0.
#
# A PIDController with a derivative gain of 1 and its usual period of 20 ms. Expected of a joint that stands still: 0.
# What happens: the error before the first one is taken as 0, so that the first output is -50, and again after each
# reset(). With enableContinuousInput(-pi, pi) the error is kept within half a turn, but its change is not: for a
# joint that creeps past the point opposite to its goal, from 3.1 to 3.2 rad, the output is 309 for one step, and -5
# is right. A drive that is limited to 12 V gets its full voltage for one period, towards the goal at the start, and
# at the half turn in the direction of the motion that it is to damp.
# For us: add a damping of the measured speed instead of the derivative gain, or leave out the first output after
# reset().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check robotpy-wpimath==2026.2.2
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from math import isclose, pi

from wpimath.controller import PIDController

controller = PIDController(0, 0, 1)
outputs = [controller.calculate(1.0, 0.0) for _ in range(3)]
controller.reset()
outputs.append(controller.calculate(1.0, 0.0))
print('at rest, and after reset()', outputs)
assert all(isclose(given, right, abs_tol=1e-9) for given, right in zip(outputs, (-50, 0, 0, -50)))

controller = PIDController(0, 0, 1)
controller.enableContinuousInput(-pi, pi)
outputs = [controller.calculate(position, 0.0) for position in (2.9, 3.0, 3.1, 3.2, 3.3)]
print('past half a turn', outputs)
assert all(isclose(given, -0.1 / 0.02) for given in (outputs[1], outputs[2], outputs[4]))
assert isclose(outputs[3], (2 * pi - 0.1) / 0.02)
PYTHON

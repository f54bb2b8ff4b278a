#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# controlpid 0.1.0: a joint under a proportional controller whose speed is limited stops half way, and for good.
#
# A joint is driven by PID(kp=10, ki=0, kd=0, setpoint=1) with a speed of at most 5 rad/s. Expected: it runs at 5 rad/s, slows down
# from 0.5 rad on, and ends at 1 rad. What happens: it creeps to 0.5 rad and stays there, also after 100 s. The anti-windup takes the
# part of the proportional term that is beyond the limit off the integral, and there is none to give it back: ki is 0. With an
# integral gain of 0.1 the joint needs 100 s to within 0.2 rad. The greater the step, the greater the error: a step of 3 rad ends at 0.5.
# The first call also takes the derivative from 0: at rest at 1 rad, its setpoint, kd=1 gives -9.9.
# For us: limit the output outside of the controller, and call step() twice before the motor is switched on.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check controlpid==0.1.0
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
from controlpid import PID

STEP = 0.001


def ends(goal, seconds, ki=0.0, limit=5.0):
    controller = PID(10.0, ki, 0.0, setpoint=goal, out_min=-limit, out_max=limit)
    angle = 0.0
    for _ in range(round(seconds / STEP)):
        angle += STEP * controller.step(angle, STEP)
    print(f'goal {goal} rad, ki {ki}, at most {limit} rad/s: {angle:.3f} rad after {seconds} s')
    return angle


assert abs(ends(1.0, 10, limit=float('inf')) - 1) < 1e-3
assert abs(ends(1.0, 10) - 0.5) < 1e-3
assert abs(ends(1.0, 100) - 0.5) < 1e-3
assert abs(ends(3.0, 100) - 0.5) < 1e-3
assert 0.79 < ends(1.0, 100, ki=0.1) < 0.83
first = PID(0.0, 0.0, 1.0, setpoint=1.0).step(1.0, STEP)
print('derivative at rest', first)
assert abs(first + 9.9) < 0.01
PYTHON

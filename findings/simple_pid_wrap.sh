#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# simple-pid 2.0.1: error_map keeps the error of an angle within a turn, but not its derivative.
#
# For angles, the error is brought into ±π by error_map, as its documentation shows. The derivative is taken of the
# measured angle, which is not mapped: where an encoder wraps from 3.1 to -3.1 rad within 10 ms, a turn of 0.083 rad,
# the derivative is that of 6.2 rad: with Kd = 1 the output jumps to 620, where 8.3 is right, and with the wrong sign.
# For us: feed it with an unwrapped angle, such as `output_state`.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check simple-pid==2.0.1
cd "$folder"
venv/bin/python - <<'PYTHON'
import math

from simple_pid import PID


def within_a_turn(error):
    return (error + math.pi) % math.tau - math.pi


def last_output(kp, kd, angles):
    controller = PID(kp, 0.0, kd, setpoint=3.1, sample_time=None, error_map=within_a_turn)
    return [controller(angle, dt=0.01) for angle in angles][-1]


proportional, derivative = last_output(1.0, 0.0, [3.1, -3.1]), last_output(0.0, 1.0, [3.1, -3.1])
unwrapped = last_output(0.0, 1.0, [3.1, math.tau - 3.1])
print('proportional', proportional, 'derivative', derivative, 'of an unwrapped angle', unwrapped)
assert abs(proportional + 0.0832) < 1e-3
assert abs(derivative - 620) < 1e-6
assert abs(unwrapped + 8.32) < 1e-2
PYTHON

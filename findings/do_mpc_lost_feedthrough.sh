#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# do-mpc 5.1.2: an accelerometer at a joint that speeds up at 2 rad/s² reads 0 once the joint's model is discretized.
#
# A joint of 1 kg·m² has a measurement of its acceleration, its torque less its friction: y = C x + D u. Expected
# of LinearModel.discretize(), which is by scipy's cont2discrete(): D stays as it is. What happens: the model that it
# returns has no D, without a warning, so that with a torque of 2 N·m at standstill the simulated accelerometer reads 0,
# and at a speed of 1 rad/s with a friction of 0.5 N·m·s/rad it reads -0.5 instead of 1.5 rad/s².
# For us: call cont2discrete() and give its four matrices to the setup() of a discrete LinearModel, which is right.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check do_mpc==5.1.2 casadi==3.8.2 numpy==2.4.6 scipy==1.17.1
cat > "$folder/accelerometer.py" <<'PYTHON'
import do_mpc
import numpy as np
from scipy.signal import cont2discrete

STEP = 0.001
A, B = np.array([[0.0, 1.0], [0.0, -0.5]]), np.array([[0.0], [1.0]])
C, D = np.array([[0.0, -0.5]]), np.array([[1.0]])


def joint(kind, matrices):
    model = do_mpc.model.LinearModel(kind)
    model.set_variable('_x', 'angle')
    model.set_variable('_x', 'speed')
    model.set_variable('_u', 'torque')
    model.setup(*matrices)
    return model


def reading(model, speed):
    simulator = do_mpc.simulator.Simulator(model)
    simulator.set_param(t_step=STEP)
    simulator.setup()
    simulator.x0 = np.array([[0.0], [speed]])
    return float(simulator.make_step(np.array([[2.0]]))[0, 0])


continuous = joint('continuous', (A, B, C, D))
discretized = continuous.discretize(STEP)
given = joint('discrete', cont2discrete((A, B, C, D), STEP)[:4])
print('D', continuous.sys_D, discretized.sys_D, given.sys_D)
assert continuous.sys_D == 1 and discretized.sys_D == 0 and given.sys_D == 1
for speed, right, read in (0.0, 2.0, 0.0), (1.0, 1.5, -0.5):
    print('speed', speed, 'discretized', reading(discretized, speed), 'four matrices', reading(given, speed))
    assert abs(reading(given, speed) - right) < 0.01 and abs(reading(discretized, speed) - read) < 0.01
PYTHON
timeout 60 "$folder/venv/bin/python" -W ignore "$folder/accelerometer.py"

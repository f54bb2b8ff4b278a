#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# do-mpc 5.1.2: a joint at its goal of 1 rad that is given this goal once more leaves it and stays at 0.48 rad.
#
# A joint against a spring of 5 N·m/rad has an LQR with a penalty on the rate of its torque (set_rterm). Expected of
# set_setpoint(xss, uss), either of which may be left out: what is left out stays as it was. What happens: with the
# goal of 1 rad and its torque of 5 N·m given together the joint goes to 1 rad and stays. When the same goal of 1 rad
# is then given alone, the torque's goal is 0 without a warning, and the joint goes to 0.48 rad. Without set_rterm()
# the torque's goal stays and so does the joint.
# For us: give both at each call of set_setpoint().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check do_mpc==5.1.2 casadi==3.8.2 numpy==2.4.6 scipy==1.17.1
cat > "$folder/goal.py" <<'PYTHON'
import do_mpc
import numpy as np

STIFFNESS, GOAL, STEP = 5.0, np.array([[1.0], [0.0]]), 0.05


def angles(rated):
    """The joint's angle after 10 s with goal and torque, and after 10 s more with the same goal alone."""
    model = do_mpc.model.LinearModel('continuous')
    model.set_variable('_x', 'angle')
    model.set_variable('_x', 'speed')
    model.set_variable('_u', 'torque')
    a = np.array([[0.0, 1.0], [-STIFFNESS, -1.0]])
    b = np.array([[0.0], [1.0]])
    model.setup(a, b)
    joint = model.discretize(STEP)
    lqr = do_mpc.controller.LQR(joint)
    lqr.settings.t_step = STEP
    lqr.settings.n_horizon = None
    lqr.set_objective(Q=np.diag([100.0, 1.0]), R=np.eye(1))
    if rated:
        lqr.set_rterm(delR=np.eye(1))
    lqr.setup()
    simulator = do_mpc.simulator.Simulator(joint)
    simulator.set_param(t_step=STEP)
    simulator.setup()
    state = np.zeros((2, 1))
    simulator.x0 = state
    reached = []
    lqr.set_setpoint(xss=GOAL, uss=np.array([[STIFFNESS * GOAL[0, 0]]]))
    for _ in range(2):
        for _ in range(200):
            torque = lqr.make_step(state)
            state = simulator.make_step(torque)
        reached.append(float(state[0, 0]))
        lqr.set_setpoint(xss=GOAL)
    print('rate of the torque penalized' if rated else 'standard', reached)
    return reached


for rated, stays in (False, 1.0), (True, 0.4832):
    first, again = angles(rated)
    assert abs(first - 1) < 1e-6 and abs(again - stays) < 1e-3
PYTHON
timeout 60 "$folder/venv/bin/python" -W ignore "$folder/goal.py"

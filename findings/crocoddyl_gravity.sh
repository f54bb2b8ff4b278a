#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# crocoddyl 3.2.1: with the Pinocchio 4.1.0 that pip installs beside it, gravity does not pull at an arm.
#
# pip installs crocoddyl 3.2.1 with the newest Pinocchio, 4.1.0, as its metadata sets no bound. A level arm with 1 kg at
# 1 m falls by 9.81 rad/s² without a torque, and is held by 9.81 N·m. By DifferentialActionModelFreeFwdDynamics it does
# not fall, and the torque of its own quasiStatic() turns it up by 9.81 rad/s²; after 0.1 s of simulation by
# IntegratedActionModelEuler it stands where it was. Nothing warns. Pinocchio itself, the action with contacts, and the
# same action once its armature is set to 0 are right in the same process. With Pinocchio 4.0.0 all of them are right.
# For us: install pin==4.0.0 beside it, and compare an acceleration with pinocchio.aba() before a motion is optimized.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
cat > "$folder/arm.py" <<'PYTHON'
import sys

import crocoddyl
import numpy as np
import pinocchio

found_fall, found_held, found_speed = map(float, sys.argv[1:])
model = pinocchio.Model()
joint = model.addJoint(0, pinocchio.JointModelRY(), pinocchio.SE3.Identity(), 'shoulder')
load = pinocchio.Inertia(1.0, np.array([1.0, 0, 0]), np.zeros((3, 3)))
model.appendBodyToJoint(joint, load, pinocchio.SE3.Identity())
level, none = np.zeros(2), np.zeros(1)
state = crocoddyl.StateMultibody(model)
motor = crocoddyl.ActuationModelFull(state)
costs = crocoddyl.CostModelSum(state)
free = crocoddyl.DifferentialActionModelFreeFwdDynamics(state, motor, costs)
contact = crocoddyl.DifferentialActionModelContactFwdDynamics(
    state, motor, crocoddyl.ContactModelMultiple(state), costs
)


def acceleration(action, torque):
    data = action.createData()
    action.calc(data, level, torque)
    return data.xout[0]


holding = free.quasiStatic(free.createData(), level)
print('Pinocchio', pinocchio.__version__, 'crocoddyl', crocoddyl.__version__)
print('aba', pinocchio.aba(model, model.createData(), none, none, none)[0], 'contact', acceleration(contact, none))
print('free: fall', acceleration(free, none), 'held by', holding[0], 'N·m', acceleration(free, holding))
assert abs(pinocchio.aba(model, model.createData(), none, none, none)[0] - 9.81) < 1e-9
assert abs(acceleration(contact, none) - 9.81) < 1e-9 and abs(holding[0] + 9.81) < 1e-9
assert abs(acceleration(free, none) - found_fall) < 1e-9
assert abs(acceleration(free, holding) - found_held) < 1e-9
step = crocoddyl.IntegratedActionModelEuler(free, 0.01)
data, now = step.createData(), level
for _ in range(10):
    step.calc(data, now, none)
    now = data.xnext.copy()
print('after 0.1 s', now)
assert abs(now[1] - found_speed) < 0.01
free.armature = np.zeros(1)
assert abs(acceleration(free, none) - 9.81) < 1e-9
PYTHON
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check crocoddyl==3.2.1 pin==4.1.0
timeout 60 "$folder/venv/bin/python" "$folder/arm.py" 0 -9.81 0
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check crocoddyl==3.2.1 pin==4.0.0
timeout 60 "$folder/venv/bin/python" "$folder/arm.py" 9.81 0 0.981

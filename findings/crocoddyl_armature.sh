#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# crocoddyl 3.2.1: a rotor's inertia that is in the model and in `armature` of an action counts twice.
#
# A joint of 0.1 kg·m² has a rotor whose inertia at the output is 0.4 kg·m², the armature of an MJCF, which Pinocchio
# reads into model.armature. Expected: an action that is made from this model has an armature of 0.4, and setting it to
# 0.4 changes nothing, so that 1 N·m gives 2 rad/s². What happens: the action's armature reads 0 while 0.4 counts; set
# to 0.4, it is added once more, 1.11 rad/s² with and without contacts, and setting it to 0 does not take it away. The
# inverse dynamics has no armature and keeps to 0.4, so that its torque for 2 rad/s² gives 1.11 rad/s² in the others.
# For us: set the inertia in model.armature alone.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check crocoddyl==3.2.1 pin==4.0.0
cat > "$folder/gear.xml" <<'MJCF'
<mujoco>
  <option gravity="0 0 0"/>
  <worldbody>
    <body name="arm"><joint name="output" axis="0 0 1" armature="0.4"/>
      <inertial pos="0 0 0" mass="1" diaginertia="0.1 0.1 0.1"/></body>
  </worldbody>
</mujoco>
MJCF
timeout 60 "$folder/venv/bin/python" - "$folder/gear.xml" <<'PYTHON'
import sys

import crocoddyl
import numpy as np
import pinocchio

model = pinocchio.buildModelFromMJCF(sys.argv[1])
assert model.armature.tolist() == [0.4]
rest, torque = np.zeros(2), np.ones(1)
state = crocoddyl.StateMultibody(model)
motor = crocoddyl.ActuationModelFull(state)
costs = crocoddyl.CostModelSum(state)
free = crocoddyl.DifferentialActionModelFreeFwdDynamics(state, motor, costs)
contact = crocoddyl.DifferentialActionModelContactFwdDynamics(
    state, motor, crocoddyl.ContactModelMultiple(state), costs
)
inverse = crocoddyl.DifferentialActionModelFreeInvDynamics(state, motor, costs)


def acceleration(action):
    data = action.createData()
    action.calc(data, rest, torque)
    return data.xout[0]


for action in free, contact:
    assert action.armature.tolist() == [0]
    found = [acceleration(action)]
    for armature in 0.4, 0:
        action.armature = np.array([armature])
        found.append(acceleration(action))
    print(type(action).__name__, 'as made, with 0.4, with 0:', found, 'rad/s²')
    assert np.allclose(found, (1 / 0.5, 1 / 0.9, 1 / 0.5))
data = inverse.createData()
inverse.calc(data, rest, np.array([2.0]))
inverse.calcDiff(data, rest, np.array([2.0]))
print('inverse dynamics: 2 rad/s² by', data.multibody.joint.dtau_du[0, 0] * 2, 'N·m')
assert abs(data.multibody.joint.dtau_du[0, 0] * 2 - 1) < 1e-9
PYTHON

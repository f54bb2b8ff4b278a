#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mink 1.3.0: the output of a gear turns in its inverse kinematics while its rotor stands still.
#
# Expected: the joint equality of the MJCF, out = -rotor / 19, is kept, as its simulation keeps it. What happens:
# solve_ik() knows nothing of equalities: the output turns to its target of 0.2 rad, the rotor stays at 0, without a
# warning. With an EqualityConstraintTask among the tasks, the rotor gets to -3.8 rad; but where a VelocityLimit of 1
# rad/s holds it, the output of such a gear goes 56 % further than the rotor allows.
# For us: give the EqualityConstraintTask in constraints=, where the ratio is kept under a limit too.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mink==1.3.0 mujoco==4.0.0 daqp==0.11.0 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import mink
import mujoco
import numpy as np

model = mujoco.MjModel.from_xml_string('''
<mujoco>
  <option gravity="0 0 0"/>
  <worldbody>
    <body><joint name="rotor" axis="0 0 1"/><geom size=".1" mass="1"/></body>
    <body pos="1 0 0"><joint name="out" axis="0 0 1"/><geom size=".1" mass="1"/><site name="tip" pos=".5 0 0"/></body>
  </worldbody>
  <equality><joint joint1="out" joint2="rotor" polycoef="0 -0.05263157894736842 0 0 0"/></equality>
</mujoco>''')
tip = mink.FrameTask('tip', 'site', position_cost=1.0, orientation_cost=0.0)
tip.set_target(mink.SE3.from_translation(np.array([1 + 0.5 * np.cos(0.2), 0.5 * np.sin(0.2), 0.0])))
gear = mink.EqualityConstraintTask(model, cost=1.0)
limit = mink.VelocityLimit(model, {'rotor': 1.0})


def reached(steps, tasks, **options):
    configuration = mink.Configuration(model)
    for _ in range(steps):
        velocity = mink.solve_ik(configuration, tasks, 0.01, solver='daqp', **options)
        configuration.integrate_inplace(velocity, 0.01)
    rotor, out = configuration.q
    return rotor, out, -19 * out / rotor if rotor else np.inf


free = reached(500, [tip])
task = reached(2000, [tip, gear])
limited = reached(100, [tip, gear], limits=[limit])
kept = reached(100, [tip], limits=[limit], constraints=[gear])
print('rotor, output and ratio error: alone', free, 'task', task, 'limited', limited, 'constraint', kept)
assert free[0] == 0 and abs(free[1] - 0.2) < 1e-3
assert abs(task[2] - 1) < 1e-3 and abs(kept[2] - 1) < 1e-3
assert abs(limited[2] - 1.56) < 0.02
PYTHON

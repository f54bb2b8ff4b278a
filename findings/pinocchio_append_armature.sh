#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# Pinocchio 4.1.0: two arms that are joined by appendModel() have both lost the inertia of their rotors, the armature,
# and their gravity.
#
# Two arms, each with an armature of 0.4 kg·m², as that of a rotor of 0.001 kg·m² behind a gear of 20, and with limits,
# damping and friction, are joined, one on the other or a tool to an arm. Expected: a model with an armature of
# (0.4, 0.4), as it has the limits, damping, friction, rotorInertia and rotorGearRatio of both, and a mass matrix that
# has 0.4 more on its diagonal. What happens: the armature is (0, 0), also that of the model that is appended to, so
# that a motor of 1 N·m accelerates the outer joint at 11.9 instead of 1.9 rad/s², as if its rotor had no inertia.
# Where both arms are mounted on a wall, by a gravity of 9.81 m/s² along x, the joined one has -9.81 m/s² along z.
# buildReducedModel() keeps both.
# For us: copy the armature of both models to the joined one, in the order of its joints, and set its gravity.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pin==4.1.0 numpy==2.4.6
cat > "$folder/arms.py" <<'PYTHON'
import numpy as np
import pinocchio as pin

URDF = """<robot name="{0}"><link name="{0}_stator"/><link name="{0}_arm">
  <inertial><origin xyz="0.4 0 0"/><mass value="1"/>
    <inertia ixx="0.12" iyy="0.12" izz="0.12" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="{0}_joint" type="revolute"><parent link="{0}_stator"/><child link="{0}_arm"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" effort="10" velocity="3"/><dynamics damping="0.1" friction="0.2"/></joint></robot>"""


def arm(name):
    model = pin.buildModelFromXML(URDF.format(name))
    model.armature[:] = 0.4
    model.rotorInertia[:] = 0.001
    model.rotorGearRatio[:] = 20
    model.gravity.linear = np.array([9.81, 0, 0])
    return model


upper, fore = arm('upper'), arm('fore')
joined = pin.appendModel(upper, fore, upper.getFrameId('upper_arm'), pin.SE3(np.eye(3), np.array([0.8, 0, 0])))
for name, value in ('rotorInertia', 0.001), ('rotorGearRatio', 20), ('damping', 0.1), ('effortLimit', 10):
    assert np.allclose(getattr(joined, name), (value, value)), name
print('joints', list(joined.names)[1:], 'armature', joined.armature, 'gravity', joined.gravity.linear)
assert np.array_equal(upper.armature, [0.4]) and np.array_equal(joined.armature, [0, 0])
assert np.allclose(upper.gravity.linear, (9.81, 0, 0)) and np.allclose(joined.gravity.linear, (0, 0, -9.81))
lost = pin.crba(joined, joined.createData(), np.zeros(2)).copy()
torque = np.array([0.0, 1.0])
without = pin.aba(joined, joined.createData(), np.zeros(2), np.zeros(2), torque)
fixed = joined.copy()
fixed.armature[:] = 0.4
fixed.gravity.linear = upper.gravity.linear
right = pin.crba(fixed, fixed.createData(), np.zeros(2))
with_rotors = pin.aba(fixed, fixed.createData(), np.zeros(2), np.zeros(2), torque)
print('mass matrix', lost.tolist(), 'with the rotors', right.tolist())
print('accelerations for 1 N·m at the outer joint, rad/s²:', without, 'with the rotors', with_rotors)
assert np.allclose(right - lost, 0.4 * np.eye(2)) and without[1] > 2 * with_rotors[1]
reduced = pin.buildReducedModel(fixed, [1], np.zeros(2))
assert np.array_equal(reduced.armature, [0.4]) and np.array_equal(reduced.gravity.linear, fixed.gravity.linear)
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/arms.py"

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# Pinocchio 4.1.0: the inertia of the rotor, the gear ratio, the damping and the friction of a model have no effect.
#
# A model has rotorInertia and rotorGearRatio, and reads damping and friction from the URDF. With a rotor of 0.01 kg·m²
# behind a ratio of 19, an arm of 1 kg·m² needs 4.61 N·m for 1 rad/s²; with a damping of 0.7 N·m·s/rad and a friction
# of 0.2 N·m, 0.9 N·m more at 1 rad/s. crba, rnea and aba go by 1 kg·m² and 1 N·m. Only armature counts.
# For us: set `model.armature` to the inertia of the rotor times the square of the ratio, and add friction by hand.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pin==4.1.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
import pinocchio

model = pinocchio.buildModelFromXML("""
<robot name="gear">
  <link name="stator"/>
  <link name="arm">
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="joint" type="revolute">
    <parent link="stator"/><child link="arm"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="10" velocity="10"/><dynamics damping="0.7" friction="0.2"/>
  </joint>
</robot>
""")
assert (model.damping[0], model.friction[0]) == (0.7, 0.2)
model.rotorInertia[:], model.rotorGearRatio[:] = 0.01, 19
position, one = np.zeros(1), np.ones(1)


def answers():
    data = model.createData()
    return (
        pinocchio.crba(model, data, position)[0, 0],
        pinocchio.rnea(model, data, position, one, one)[0],
        pinocchio.aba(model, data, position, one, one)[0],
    )


print('rotor, ratio, damping and friction: crba, rnea, aba', answers())
assert np.allclose(answers(), 1)
model.armature[:] = model.rotorInertia * model.rotorGearRatio**2
print('armature: crba, rnea, aba', answers())
assert np.allclose(answers(), (4.61, 4.61, 1 / 4.61))
PYTHON

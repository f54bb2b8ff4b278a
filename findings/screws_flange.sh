#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# screws 0.7.0: a tool of 5 kg at a flange of a URDF needs no torque at the joint that bears it, 24.5 N·m are right.
#
# The output of a joint bears a tool by a fixed joint, 0.5 m from the axis. Expected: gravity_forces() is 24.525 N·m and
# the inertia 1.28 kg·m², as the documentation of load() says only that fixed joints "add no column". What happens: they
# are 0 and 0.01 kg·m², those of the output alone: the mass of every link behind a fixed joint is left out, without a
# warning. Pinocchio 4.1.0 counts it.
# For us: merge the masses of fixed links into the moving link before, or use Pinocchio.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check screws==0.7.0 pin==4.1.0 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
import pinocchio
from screws.urdf import load

URDF = """
<robot name="gear">
  <link name="stator"/>
  <link name="output"><inertial><mass value="1"/>
    <inertia ixx=".01" iyy=".01" izz=".01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="tool"><inertial><origin xyz="0.1 0 0"/><mass value="5"/>
    <inertia ixx=".02" iyy=".02" izz=".02" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="joint" type="revolute"><parent link="stator"/><child link="output"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="90" velocity="2"/></joint>
  <joint name="flange" type="fixed"><parent link="output"/><child link="tool"/><origin xyz="0.4 0 0"/></joint>
</robot>"""
down = np.array([0, -9.81, 0])
robot = load(URDF).with_gravity(down)
torque, inertia = robot.gravity_forces(np.zeros(1))[0], robot.mass_matrix(np.zeros(1))[0, 0]
model = pinocchio.buildModelFromXML(URDF)
model.gravity.linear = down
data = model.createData()
right = pinocchio.computeGeneralizedGravity(model, data, np.zeros(1))[0], pinocchio.crba(model, data, np.zeros(1))[0, 0]
print('screws', torque, 'N·m', inertia, 'kg·m², Pinocchio', right)
assert torque == 0 and abs(inertia - 0.01) < 1e-12
assert np.allclose(right, (5 * 9.81 * 0.5, 0.01 + 0.02 + 5 * 0.5**2))
PYTHON

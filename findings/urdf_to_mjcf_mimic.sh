#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# urdf-to-mjcf 0.1.1: the gear ratio of a mimic is inverted: 1/20 becomes 20, and damping and friction are lost.
#
# An output mimics a motor by -0.05 with an offset of 0.2. MuJoCo reads the equality of an MJCF as joint1 = offset +
# factor * joint2, so joint1 has to be the one that follows. urdf-mujoco-converter 0.1.0 writes the output first.
# urdf-to-mjcf writes the motor first with the same numbers: where the output turns by 1 rad the motor turns by -0.05
# rad. The damping and friction of the motor are not in its file. It warns of neither.
# For us: turn one joint of a converted model, and look whether the faster one is the motor.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check urdf-to-mjcf==0.1.1 urdf-mujoco-converter==0.1.0 mujoco==3.11.0
cd "$folder"
cat > gear.urdf <<'URDF'
<robot name="gear">
  <link name="stator"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="rotor"><inertial><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="shaft"><inertial><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="motor" type="revolute"><parent link="stator"/><child link="rotor"/><axis xyz="0 0 1"/>
    <limit lower="-90" upper="90" effort="1" velocity="1"/><dynamics damping="0.3" friction="0.7"/></joint>
  <joint name="output" type="revolute"><parent link="stator"/><child link="shaft"/><axis xyz="0 0 1"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/><mimic joint="motor" multiplier="-0.05" offset="0.2"/></joint>
</robot>
URDF
venv/bin/urdf-to-mjcf gear.urdf --output to/gear.xml > log 2>&1 || { cat log; exit 1; }
venv/bin/urdf-mujoco-converter gear.urdf converter > converter.log 2>&1 || { cat converter.log; exit 1; }
if grep -iE 'mimic|damping|friction' log; then exit 1; fi
timeout 60 venv/bin/python - <<'PYTHON'
import mujoco

for path, follower, losses in (
    ('converter/robot.xml', 'output', (0.3, 0.7)),
    ('to/gear.xml', 'motor', (0.0, 0.0)),
):
    model = mujoco.MjModel.from_xml_path(path)
    first, second = model.joint(model.eq_obj1id[0]).name, model.joint(model.eq_obj2id[0]).name
    motor = model.joint('motor').dofadr[0]
    lost = (model.dof_damping[motor], model.dof_frictionloss[motor])
    print(path, f'{first} = {model.eq_data[0][0]} + {model.eq_data[0][1]} * {second}', 'damping, friction', lost)
    assert first == follower and abs(model.eq_data[0][1] + 0.05) < 1e-9 and lost == losses
PYTHON

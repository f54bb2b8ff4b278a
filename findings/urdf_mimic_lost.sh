#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# urdf2any 0.3.0, urdf2mjcf 0.2.39: the MJCF of a URDF with a mimic has a free joint, without any warning.
#
# An output mimics a motor by -1/20. MuJoCo 4.0.0 itself reads the URDF with an equality of the two joints, and the
# output follows. Both converters write two joints and no equality, and exit with 0; urdf2any says that mimic
# is not supported where it writes USD, but not where it writes MJCF. Both add an actuator to the output besides.
# Also kinpy 0.6.1 places the output at its own angle, as an independent joint.
# For us: count the equalities of a converted model before it is simulated: a gear needs one.
#
# Exit code 0: still so. Installs the packages into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check urdf2any==0.3.0 urdf2mjcf==0.2.39 kinpy==0.6.1
cd "$folder"
cat > gear.urdf <<'URDF'
<robot name="gear">
  <link name="stator"/>
  <link name="rotor"><inertial><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="shaft"><inertial><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="motor" type="revolute"><parent link="stator"/><child link="rotor"/>
    <axis xyz="0 0 1"/><limit lower="-90" upper="90" effort="1" velocity="1"/></joint>
  <joint name="output" type="revolute"><parent link="stator"/><child link="shaft"/>
    <axis xyz="0 0 1"/><limit lower="-9" upper="9" effort="1" velocity="1"/>
    <mimic joint="motor" multiplier="-0.05"/></joint>
</robot>
URDF
venv/bin/urdf2any gear.urdf -o urdf2any.xml > urdf2any.log 2>&1
venv/bin/urdf2mjcf gear.urdf --output urdf2mjcf.xml > urdf2mjcf.log 2>&1
for converter in urdf2any urdf2mjcf; do
    echo "$converter: $(grep -o '<joint name="[a-z]*"' $converter.xml | tr '\n' ' ')"
    test "$(grep -c '<joint name="' $converter.xml)" = 2
    if grep -q equality $converter.xml || grep -qi mimic $converter.log; then exit 1; fi
done
venv/bin/urdf2any gear.urdf -o gear.usda 2>&1 | grep 'mimic is not supported'
venv/bin/python - <<'PYTHON'
import kinpy

chain = kinpy.build_chain_from_urdf(open('gear.urdf').read())
placed = chain.forward_kinematics({'motor': 2.0})['shaft'].rot_euler[2]
print('kinpy', chain.get_joint_parameter_names(), placed)
assert chain.get_joint_parameter_names() == ['motor', 'output'] and placed == 0.0
PYTHON
python3 -m venv "$folder/mujoco"
"$folder/mujoco/bin/pip" install --quiet --disable-pip-version-check mujoco==4.0.0
mujoco/bin/python - <<'PYTHON'
import mujoco

model = mujoco.MjModel.from_xml_path('gear.urdf')
print('MuJoCo', mujoco.__version__, model.neq, 'equality', model.eq_data[0][:2])
assert model.neq == 1 and model.eq_data[0][1] == -0.05
PYTHON

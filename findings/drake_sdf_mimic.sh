#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# Drake 1.51.1: the mimic of a URDF couples two joints, the mimic of an SDFormat file does not, without a warning.
#
# SDFormat has the element mimic since its version 1.11, and converters write it for that of a URDF. Drake makes a
# constraint of the mimic in the URDF, and none of that in the SDFormat file: the rotor is a free joint. Drake's own
# element drake:mimic makes one.
# For us: give Drake the URDF, or count `plant.num_constraints()` after Finalize().
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check drake==1.51.1
cat > "$folder/mimic.py" <<'PYTHON'
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

URDF = """
<robot name="gear">
  <link name="stator"/>
  <link name="output"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="rotor"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="fixed" type="fixed"><parent link="world"/><child link="stator"/></joint>
  <joint name="output" type="continuous"><parent link="stator"/><child link="output"/><axis xyz="0 0 1"/></joint>
  <joint name="rotor" type="continuous">
    <parent link="stator"/><child link="rotor"/><axis xyz="0 0 1"/><mimic joint="output" multiplier="-19"/>
  </joint>
</robot>
"""
SDF = """
<sdf version="1.11" xmlns:drake="drake">
  <model name="gear">
    <link name="stator"/><link name="output"/><link name="rotor"/>
    <joint name="fixed" type="fixed"><parent>world</parent><child>stator</child></joint>
    <joint name="output_joint" type="revolute">
      <parent>stator</parent><child>output</child><axis><xyz>0 0 1</xyz></axis>
    </joint>
    <joint name="rotor_joint" type="revolute">
      <parent>stator</parent><child>rotor</child><axis><xyz>0 0 1</xyz>{}</axis>{}
    </joint>
  </model>
</sdf>
"""
STANDARD = """
<mimic joint="output_joint" axis="axis">
  <multiplier>-19</multiplier><offset>0</offset><reference>0</reference>
</mimic>
"""
OWN = '<drake:mimic joint="output_joint" multiplier="-19" offset="0"/>'
for name, text, kind, expected in (
    ('URDF', URDF, 'urdf', 1),
    ('SDFormat', SDF.format(STANDARD, ''), 'sdf', 0),
    ('SDFormat with drake:mimic', SDF.format('', OWN), 'sdf', 1),
):
    plant = MultibodyPlant(0.001)
    Parser(plant).AddModelsFromString(text, kind)
    plant.Finalize()
    print(name, plant.num_positions(), 'positions and', plant.num_constraints(), 'constraints')
    assert (plant.num_positions(), plant.num_constraints()) == (2, expected)
PYTHON
timeout 90 "$folder/venv/bin/python" "$folder/mimic.py" 2> "$folder/log" || { cat "$folder/log"; exit 1; }
if grep -i mimic "$folder/log"; then exit 1; fi

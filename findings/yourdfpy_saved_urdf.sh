#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# yourdfpy 0.0.60: a URDF that is saved has lost its mimic, its soft limits and its transmission.
#
# A rotor that mimics its output with a multiplier of -19 moves with it in the library. After write_xml_file() it is a
# joint of its own, which nothing moves, in whatever reads the file, and no warning is given.
# The elements mimic, calibration, safety_controller and transmission are not written; limit and dynamics are.
# For us: change the XML of a robot description itself, or generate it again from the parameters.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check yourdfpy==0.0.60
cd "$folder"
cat > gear.urdf <<'URDF'
<robot name="gear">
  <link name="stator"/><link name="output"/><link name="rotor"/>
  <joint name="output" type="revolute">
    <parent link="stator"/><child link="output"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="2" velocity="3"/>
    <calibration rising="0.5"/>
    <dynamics damping="0.7" friction="0.2"/>
    <safety_controller soft_lower_limit="-0.9" soft_upper_limit="0.9" k_position="10" k_velocity="5"/>
  </joint>
  <joint name="rotor" type="continuous">
    <parent link="stator"/><child link="rotor"/><axis xyz="0 0 1"/>
    <mimic joint="output" multiplier="-19" offset="0.3"/>
  </joint>
  <transmission name="drive">
    <type>transmission_interface/SimpleTransmission</type>
    <joint name="output"><hardwareInterface>EffortJointInterface</hardwareInterface></joint>
    <actuator name="motor"><mechanicalReduction>-19</mechanicalReduction></actuator>
  </transmission>
</robot>
URDF
timeout 90 venv/bin/python - <<'PYTHON'
import xml.etree.ElementTree as ElementTree

import yourdfpy

model = yourdfpy.URDF.load('gear.urdf')
model.write_xml_file('saved.urdf')
saved = yourdfpy.URDF.load('saved.urdf')
print('moving joints', model.actuated_joint_names, 'and in the saved file', saved.actuated_joint_names)
assert model.actuated_joint_names == ['output']
assert saved.actuated_joint_names == ['output', 'rotor']


def elements(path):
    return {element.tag for element in ElementTree.parse(path).getroot().iter()}


lost = elements('gear.urdf') - elements('saved.urdf')
print('lost:', ' '.join(sorted(lost)))
assert {'mimic', 'calibration', 'safety_controller', 'transmission', 'mechanicalReduction'} <= lost
assert {'limit', 'dynamics'} <= elements('saved.urdf')
PYTHON

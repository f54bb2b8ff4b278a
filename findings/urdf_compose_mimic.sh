#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# urdf-compose 0.4.1: of two equal geared actuators in one robot, the output of the second follows the first's motor.
#
# The URDF of an actuator has a motor, and an output that mimics it by 1/20. branch() puts it at both arms of a base.
# Expected: each output follows its own motor. What happens: the joints of the second actuator become motor(1) and
# output(1), but its mimic still names "motor", as only attributes called name and link are renamed. The motor of the
# first arm therefore turns both outputs, and that of the second arm none; Pinocchio 4.1.0 loads this without an error.
# For us: give the joints of each actuator names of their own, by xacro, before URDFs are put together.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    urdf-compose==0.4.1 typing-extensions==4.15.0 pin==4.1.0 numpy==2.4.6
cd "$folder"
cat > base.urdf <<'URDF'
<robot name="base">
  <link name="base"/><link name="OUTPUT-left"/><link name="OUTPUT-right"/>
  <joint name="left" type="fixed"><parent link="base"/><child link="OUTPUT-left"/><origin xyz="0 1 0"/></joint>
  <joint name="right" type="fixed"><parent link="base"/><child link="OUTPUT-right"/><origin xyz="0 -1 0"/></joint>
</robot>
URDF
cat > actuator.urdf <<'URDF'
<robot name="actuator">
  <link name="INPUT-stator"/><link name="rotor"/><link name="arm"/>
  <joint name="motor" type="revolute"><parent link="INPUT-stator"/><child link="rotor"/><axis xyz="0 0 1"/>
    <limit lower="-99" upper="99" effort="1" velocity="99"/></joint>
  <joint name="output" type="revolute"><parent link="INPUT-stator"/><child link="arm"/><axis xyz="0 0 1"/>
    <limit lower="-5" upper="5" effort="20" velocity="5"/><mimic joint="motor" multiplier="0.05"/></joint>
</robot>
URDF
timeout 60 venv/bin/python - <<'PYTHON'
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pinocchio
import urdf_compose

urdf_compose.globally_disable_check_urdf()  # it needs the program check_urdf of ROS
base, actuator = urdf_compose.ExplicitURDFObj(Path('base.urdf')), urdf_compose.ExplicitURDFObj(Path('actuator.urdf'))
ends = [(actuator, urdf_compose.URDFConn(base_link=end)) for end in ('left', 'right')]
urdf_compose.raise_if_compose_error(urdf_compose.branch(base, ends)).write_xml(Path('robot.urdf'))
mimics = {joint.get('name'): joint.find('mimic').get('joint') for joint in ET.parse('robot.urdf').iter('joint')
          if joint.find('mimic') is not None}  # fmt: skip
print('mimics', mimics)
assert mimics == {'output': 'motor', 'output(1)': 'motor'}

model = pinocchio.buildModelFromUrdf('robot.urdf', mimic=True)
data = model.createData()


def turned(**angles):
    configuration = pinocchio.neutral(model)
    for name, angle in angles.items():
        configuration[model.joints[model.getJointId(name)].idx_q] = angle
    pinocchio.framesForwardKinematics(model, data, configuration)
    arms = [data.oMf[model.getFrameId(name)].rotation for name in ('arm', 'arm(1)')]
    return [float(np.arctan2(arm[1, 0], arm[0, 0])) for arm in arms]


first, second = turned(motor=20.0), turned(**{'motor(1)': 20.0})
print('the first motor at 20 rad: arms at', first, 'rad; the second:', second)
assert np.allclose(first, (1, 1)) and np.allclose(second, (0, 0))
PYTHON

#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# scikit-robot 0.4.7: angle_vector() turns a motor without its mimic, and the motor does not feel the load of it.
#
# An output is the mimic of a motor by -0.05 with an offset of 0.2 rad and stops at ±3 rad. Expected: it stays with its
# motor. What happens: it does so only where joint_angle() of the motor is called. At the start and after init_pose() it
# is at 0 instead of 0.2 rad. angle_vector() takes both angles, as joint_list has both by default, so that a vector
# which turns the motor from 2 to 4 rad leaves the output at 0.1 rad, where 0 is right. A motor that is turned to 80 rad
# goes there, while its output stops at -3 rad. torque_vector() gives the motor 0 N·m under an arm of 9.81 N·m, where
# 0.49 N·m are right. No warning names the mimic.
# For us: call joint_angle() of the motor at the start and after each angle_vector().
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check scikit-robot==0.4.7 numpy==2.3.5
cd "$folder"
cat > gear.urdf <<'URDF'
<robot name="gear">
  <link name="stator"><inertial><mass value="1"/>
    <inertia ixx=".01" iyy=".01" izz=".01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="rotor"><inertial><mass value="1"/>
    <inertia ixx=".01" iyy=".01" izz=".01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="arm"><inertial><origin xyz="0.5 0 0"/><mass value="2"/>
    <inertia ixx=".01" iyy=".01" izz=".01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="motor" type="revolute"><parent link="stator"/><child link="rotor"/><axis xyz="0 1 0"/>
    <limit lower="-100" upper="100" effort="5" velocity="100"/></joint>
  <joint name="output" type="revolute"><parent link="stator"/><child link="arm"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" effort="100" velocity="5"/><mimic joint="motor" multiplier="-0.05" offset="0.2"/></joint>
</robot>
URDF
HOME=$folder timeout 300 venv/bin/python - 2> log <<'PYTHON' || { cat log; exit 1; }
import numpy as np
from skrobot.model import RobotModel

robot = RobotModel.from_urdf('gear.urdf')


def state(name, found):
    motor, output = robot.motor.joint_angle(), robot.output.joint_angle()
    print(f'{name}: motor {motor}, output {output}, right {0.2 - 0.05 * motor}')
    assert abs(output - found) < 1e-9
    return abs(output - (0.2 - 0.05 * motor)) < 1e-9


assert not state('at the start', 0.0)
robot.motor.joint_angle(2.0)
assert state('motor.joint_angle(2)', 0.1)
robot.angle_vector(np.array([4.0, robot.output.joint_angle()]))
assert not state('angle_vector() that turns the motor alone', 0.1)
robot.motor.joint_angle(4.0)
assert state('motor.joint_angle(4)', 0.0)
robot.init_pose()
assert not state('init_pose()', 0.0)
robot.motor.joint_angle(80.0)
assert not state('motor.joint_angle(80)', -3.0)

robot.motor.joint_angle(4.0)
torques = dict(zip([joint.name for joint in robot.joint_list], robot.torque_vector(), strict=True))
print('torque_vector()', torques, 'right at the motor', 0.05 * 9.81)
assert abs(torques['motor']) < 1e-9 and abs(torques['output'] + 9.81) < 0.01
PYTHON
if grep -iE 'mimic' log; then exit 1; fi

#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# scikit-robot 0.4.7: a shoulder with a load of 59 N·m has 20 N·m, without its tool but with the other arm's weight.
#
# compute_gravity_torque() is documented to give the "torque each joint must exert to hold the pose against gravity". A
# robot has two arms of 2 kg, one of which bears a tool of 5 kg by a fixed joint, 1 m from its shoulder. Expected: 58.84
# N·m and 9.81 N·m, as torque_vector() and inverse_dynamics() of the same robot give. What happens: 19.62 N·m and 9.81
# N·m. To each joint it adds the links of all joints that come later in the list, whether they hang on it or not, and
# it leaves out each link behind a fixed joint. A lift of 2 kg needs 0 N instead of 19.6 N, as each joint is taken as a
# revolute one. There is no warning.
# For us: use torque_vector(), which is right in all of these.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check scikit-robot==0.4.7 numpy==2.3.5
cd "$folder"
HOME=$folder timeout 300 venv/bin/python - 2> log <<'PYTHON' || { cat log; exit 1; }
import numpy as np
from skrobot.dynamics import compute_gravity_torque
from skrobot.model import RobotModel

INERTIA = '<inertia ixx=".01" iyy=".01" izz=".01" ixy="0" ixz="0" iyz="0"/>'
LIMIT = '<limit lower="-3" upper="3" effort="100" velocity="1"/>'


def link(name, mass, centre):
    return f'<link name="{name}"><inertial><origin xyz="{centre} 0 0"/><mass value="{mass}"/>{INERTIA}</inertial></link>'


def torques(text):
    with open('robot.urdf', 'w') as file:
        file.write(f'<robot name="robot">{link("base", 1, 0)}{text}</robot>')
    robot = RobotModel.from_urdf('robot.urdf')
    return compute_gravity_torque(robot), robot.torque_vector(), robot.inverse_dynamics()


def arm(side, y):
    return f"""{link(side, 2, 0.5)}<joint name="shoulder_{side}" type="revolute"><origin xyz="0 {y} 0"/>
  <parent link="base"/><child link="{side}"/><axis xyz="0 1 0"/>{LIMIT}</joint>"""


tool = f"""{link('tool', 5, 0)}<joint name="flange" type="fixed"><origin xyz="1 0 0"/>
  <parent link="left"/><child link="tool"/></joint>"""
lift = f"""{link('lift', 2, 0)}<joint name="axis" type="prismatic">
  <parent link="base"/><child link="lift"/><axis xyz="0 0 1"/>{LIMIT}</joint>"""
for name, text, right, found in (
    ('one arm', arm('left', 1), [9.81], [9.81]),
    ('two arms and a tool', arm('left', 1) + tool + arm('right', -1), [58.84, 9.81], [19.62, 9.81]),
    ('lift', lift, [-19.61], [0]),
):
    gravity, vector, inverse = torques(text)
    print(name, 'compute_gravity_torque()', -gravity, 'torque_vector()', -vector, 'inverse_dynamics()', -inverse)
    assert np.allclose(-vector, right, atol=0.01) and np.allclose(-inverse, right, atol=0.01)
    assert np.allclose(-gravity, found, atol=0.01)
PYTHON
if grep -iE 'gravity|prismatic|fixed' log; then exit 1; fi

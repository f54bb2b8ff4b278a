#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# urdf2webots 2025.0.0: a motor whose stator is a link without mass is lost, so that its arm is fixed in Webots.
#
# A URDF has a base, a mount that is fixed to it and has neither mass nor shape, as frames have, and an arm that a motor
# turns on the mount. Expected in Webots: a HingeJoint, as with a mount of 1 kg. What happens: the mount is taken away,
# and with it the joint of the motor, so that the arm is a part of the base, without any warning. Of two joints one
# behind the other the second is lost in the same way if the link between them has no mass, as in a universal joint.
# The inertia of an arm that lies at +45° to its link, by the rpy of its inertial, is that of an arm at -45°: its
# product of inertia has the opposite sign. And the carriage of a vertical slide from 0.2 to 0.6 m begins at 0.4 m
# beside its column instead of 0.4 m above its base.
# For us: give each link behind a joint a mass and a matrix of inertia in its own axes, and count the joints after it.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check urdf2webots==2025.0.0 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import contextlib
import io
import re

import numpy as np
from urdf2webots.importer import convertUrdfContent

SOLID = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
ARM = """<inertial><origin xyz="0 0 0" rpy="0 0 0.785398163397448"/><mass value="1"/>
    <inertia ixx="0.01" iyy="0.05" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial>"""
URDF = """
<robot name="arm">
  <link name="base">{solid}</link><link name="mount">{mount}</link><link name="arm">{arm}</link>
  <joint name="first" type="{kind}"><parent link="base"/><child link="mount"/><origin xyz="0 0 0.3"/>
    <axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="10" velocity="2"/></joint>
  <joint name="motor" type="revolute"><parent link="mount"/><child link="arm"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="10" velocity="2"/></joint>
</robot>"""
SLIDE = """
<robot name="slide">
  <link name="base">{solid}</link><link name="carriage">{solid}</link>
  <joint name="lift" type="prismatic"><parent link="base"/><child link="carriage"/><axis xyz="0 0 1"/>
    <limit lower="0.2" upper="0.6" effort="100" velocity="1"/></joint>
</robot>"""


def webots(urdf, **parts):
    said = io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        robot = convertUrdfContent(urdf.format(solid=SOLID, **parts), robotName='robot')
    assert 'warn' not in said.getvalue().lower()
    return robot


def motors(robot):
    found = re.findall(r'Motor \{\s*name "(.*)"', robot)
    print('motors', found)
    return found


assert motors(webots(URDF, mount=SOLID, arm=ARM, kind='fixed')) == ['motor']
assert motors(webots(URDF, mount='', arm=ARM, kind='fixed')) == []
assert motors(webots(URDF, mount=SOLID, arm=ARM, kind='revolute')) == ['first', 'motor']
assert len(motors(webots(URDF, mount='', arm=ARM, kind='revolute'))) == 1

numbers = re.findall(r'inertiaMatrix \[\s*([^\]]*)\]', webots(URDF, mount=SOLID, arm=ARM, kind='fixed'))
xx, yy, zz, xy, xz, yz = map(float, numbers[0].split())
turn = np.array([[1, -1, 0], [1, 1, 0], [0, 0, 2**0.5]]) / 2**0.5
right = turn @ np.diag([0.01, 0.05, 0.05]) @ turn.T
print('product of inertia', xy, 'kg·m², right', right[0, 1])
assert np.allclose((xx, yy, zz), np.diag(right)) and np.allclose((xy, right[0, 1]), (0.02, -0.02))

slide = webots(SLIDE)
axis, position = re.search(r'axis (.*)', slide).group(1), re.search(r' position (.*)', slide).group(1)
place = re.search(r'endPoint Solid \{\s*translation (.*)', slide).group(1)
print('slide along', axis, 'at', position, 'm: carriage at', place)
assert [float(value) for value in axis.split()] == [0, 0, 1] and float(position) == 0.4
assert [float(value) for value in place.split()] == [0.4, 0, 0]
PYTHON

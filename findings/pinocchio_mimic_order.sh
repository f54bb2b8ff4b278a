#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# Pinocchio 4.1.0: whether a joint can mimic another one depends on the alphabetical order of their names.
#
# Two joints of one link: an output mimics the motor, in the URDF after it. With mimic=True, buildModelFromXML
# adds the children of a link in the order of their names. "motor" and "output" are read; of "rotor" and
# "output" it says "The parent joint of the mimic joint is not in the kinematic tree", though it is.
# Without mimic=True both are read, and the output is a free joint.
# For us: name the joint that is mimicked first in the alphabet, or couple the joints in your own code.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pin==4.1.0
"$folder/venv/bin/python" - <<'PYTHON'
import pinocchio

LINK = """<link name="{}"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>"""
JOINT = """<joint name="{0}" type="revolute"><parent link="base"/><child link="link_{0}"/>
<axis xyz="0 0 1"/><limit lower="-9" upper="9" effort="1" velocity="1"/>{1}</joint>"""


def urdf(motor):
    mimic = f'<mimic joint="{motor}" multiplier="-0.05"/>'
    links = [LINK.format(name) for name in ('base', f'link_{motor}', 'link_output')]
    joints = JOINT.format(motor, '') + JOINT.format('output', mimic)
    return f'<robot name="gear">{"".join(links)}{joints}</robot>'


assert pinocchio.buildModelFromXML(urdf('rotor')).nq == 2
model = pinocchio.buildModelFromXML(urdf('motor'), mimic=True)
print('motor:', model.nq, 'coordinate', list(model.names))
assert model.nq == 1
try:
    pinocchio.buildModelFromXML(urdf('rotor'), mimic=True)
except ValueError as error:
    print('rotor:', error)
    assert 'parent joint of the mimic joint is not in the kinematic tree' in str(error)
else:
    raise AssertionError('it is read')
PYTHON

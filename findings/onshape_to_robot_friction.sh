#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# onshape-to-robot 1.8.3: the friction and the damping of joint_properties have no effect in a URDF.
#
# The documentation of its URDF exporter gives "joint_properties" with "friction": 0.5 as an example. Expected: the
# friction of the joint, as in the SDFormat file that is exported from the same configuration. What happens: it is
# written as <joint_properties friction="0.5"/>, an element that URDF does not know, instead of <dynamics>; Pinocchio
# 4.1.0 and yourdfpy 0.0.60 read a joint without friction, and no warning says so. A damping is not written at all. The
# limits of effort and speed are right.
# For us: replace that element by <dynamics> in the exported file, or export SDFormat.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    onshape-to-robot==1.8.3 pin==4.1.0 yourdfpy==0.0.60 numpy==2.4.6
cd "$folder"
cat > config.json <<'JSON'
{
  "url": "https://cad.example.com/documents/a/w/b/e/c",
  "output_format": "urdf",
  "joint_properties": {"output": {"friction": 0.5, "damping": 0.2, "max_effort": 30, "max_velocity": 2, "limits": [-1, 1]}}
}
JSON
timeout 100 venv/bin/python - <<'PYTHON'
import numpy as np
import pinocchio
import yourdfpy
from onshape_to_robot.config import Config
from onshape_to_robot.exporter_sdf import ExporterSDF
from onshape_to_robot.exporter_urdf import ExporterURDF
from onshape_to_robot.robot import Joint, Link, Part, Robot

config = Config('config.json')
robot = Robot('arm')  # as it is built from an assembly of two parts and a revolute mate
stator, arm = Link('stator'), Link('arm')
for link in (stator, arm):
    link.parts.append(Part(link.name, np.eye(4), 1.0, np.zeros(3), np.eye(3)))
robot.links, robot.base_links = [stator, arm], [stator]
robot.joints.append(Joint('output', Joint.REVOLUTE, stator, arm, np.eye(4), config.joint_properties['output']))

sdf = ExporterSDF(config).build(robot)
assert '<friction>0.5</friction>' in sdf and '<damping>0.2</damping>' in sdf
urdf = ExporterURDF(config).build(robot)
assert '<joint_properties friction="0.5"/>' in urdf and 'dynamics' not in urdf and 'damping' not in urdf
with open('robot.urdf', 'w') as file:
    file.write(urdf)
joint = yourdfpy.URDF.load('robot.urdf').joint_map['output']
print('yourdfpy', joint.dynamics, joint.limit)
assert joint.dynamics is None and (joint.limit.effort, joint.limit.velocity) == (30, 2)


def pinocchio_reads(text):
    model = pinocchio.buildModelFromXML(text)
    read = float(model.upperDryFrictionLimit[0]), float(model.damping[0]), float(model.effortLimit[0])
    print('Pinocchio: friction, damping and effort', read)
    return read


assert pinocchio_reads(urdf) == (0, 0, 30)
repaired = urdf.replace('<joint_properties friction="0.5"/>', '<dynamics friction="0.5" damping="0.2"/>')
assert pinocchio_reads(repaired) == (0.5, 0.2, 30)
PYTHON

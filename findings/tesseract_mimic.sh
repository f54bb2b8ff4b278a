#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# tesseract-robotics 0.5.1: the output of a gear, a mimic of a URDF, stands still at 0 rad while its rotor turns, and a
# continuous rotor has stops at two turns.
#
# A URDF has a continuous rotor, and an output that mimics it by 0.05 and an offset of 0.1 rad. Expected of both of its
# state solvers, with the rotor at 10 rad: one active joint, and the output at 0.6 rad. What happens: the mimic is read
# rightly into the scene graph, but the solvers have two independent active joints; the output stays at 0 rad, and can
# be set to any angle. Expected of the limits of the rotor, which its URDF does
# not have: none. What happens: ±12.566 rad, two turns. Each joint has also a limit of its acceleration, half of the
# number of its greatest speed, which no URDF has.
# For us: set the output of each gear together with its rotor, and widen the limits of continuous joints.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check tesseract-robotics==0.5.1 numpy==2.4.6
cat > "$folder/gear.py" <<'PYTHON'
import math

import numpy as np
import tesseract_robotics.tesseract_scene_graph  # The types of what the parser gives.
from tesseract_robotics.tesseract_common import GeneralResourceLocator
from tesseract_robotics.tesseract_state_solver import KDLStateSolver, OFKTStateSolver
from tesseract_robotics.tesseract_urdf import parseURDFString

URDF = """<robot name="gear"><link name="stator"/><link name="shaft"/><link name="arm"/>
  <joint name="rotor" type="continuous"><parent link="stator"/><child link="shaft"/><axis xyz="0 0 1"/>
    <limit effort="1" velocity="100"/></joint>
  <joint name="output" type="revolute"><parent link="stator"/><child link="arm"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="2" effort="20" velocity="5"/>
    <mimic joint="rotor" multiplier="0.05" offset="0.1"/></joint></robot>"""
graph = parseURDFString(URDF, GeneralResourceLocator()).release()
mimic = graph.getJoint('output').mimic
print('mimic in the scene graph:', mimic.joint_name, mimic.multiplier, mimic.offset)
assert (mimic.joint_name, mimic.multiplier, mimic.offset) == ('rotor', 0.05, 0.1)
limits = graph.getJoint('rotor').limits
print('limits of the continuous rotor:', limits.lower, limits.upper, 'rad,', limits.acceleration, 'rad/s²')
assert np.allclose((limits.lower, limits.upper, limits.acceleration), (-4 * math.pi, 4 * math.pi, 50))


def turned(state):
    """The angle of the arm in the pose of its link, in rad."""
    pose = state.link_transforms['arm'].matrix()
    return math.atan2(pose[1, 0], pose[0, 0])


for kind in KDLStateSolver, OFKTStateSolver:
    solver = kind(graph)
    solver.setState(['rotor'], np.array([10.0]))
    state = solver.getState()
    joints = list(solver.getActiveJointNames())
    print(f'{kind.__name__}: active {joints}, rotor {state.joints["rotor"]} rad, arm {turned(state)} rad')
    assert sorted(joints) == ['output', 'rotor'] and state.joints['rotor'] == 10 and abs(turned(state)) < 1e-12
    solver.setState(['output'], np.array([-0.5]))
    state = solver.getState()
    assert state.joints['rotor'] == 10 and abs(turned(state) + 0.5) < 1e-12
PYTHON
timeout 100 "$folder/venv/bin/python" "$folder/gear.py"

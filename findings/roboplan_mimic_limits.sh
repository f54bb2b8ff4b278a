#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# roboplan 0.7.0: an arm behind a geared joint, whose limit in the URDF is 1 rad/s, is moved at 8.6 rad/s.
#
# An output turns 5 times as fast as its motor, by a mimic, and an arm is the joint behind it. The motor has limits of
# 10 rad/s and 10 rad/s², the arm of 1 rad/s and 2 rad/s². Expected of getVelocityLimitVectors() and
# getAccelerationLimitVectors(), with one number for each of the two free joints: (10, 1) rad/s and (10, 2) rad/s².
# What happens, in a group with all three joints and in the default group: (10, 50) rad/s and (10, 50) rad/s², as the
# arm gets the limits of the mimic, which are those of its motor times 5, not its own. The limits of positions are
# right. By them, a trajectory of the arm by 1.5 rad takes 0.36 s instead of 2.08 s, at 8.6 rad/s and 50 rad/s². With a
# multiplier of 0.05 the arm is too slow. In a group without the mimic, or a URDF without it, all of this is right.
# It is documented that a mimic gets the limits of its motor, scaled; not that the joint behind it gets them.
# For us: plan in groups that leave out each mimic, and compare the limits with those of getJointInfo().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check roboplan==0.7.0 roboplan-core==0.7.0 \
  roboplan-toppra==0.7.0 roboplan-common==0.7.0 pin==4.1.0 numpy==2.4.6
cat > "$folder/limits.yaml" <<'YAML'
joint_limits:
  motor:
    max_acceleration: [10.0]
  arm:
    max_acceleration: [2.0]
YAML
cat > "$folder/limits.py" <<'PYTHON'
import sys

import numpy as np
from roboplan import core, toppra

LINK = """<link name="{}"><inertial><mass value="1"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>"""
JOINT = """<joint name="{}" type="revolute"><parent link="{}"/><child link="{}"/><axis xyz="0 0 1"/>
  <limit lower="-{}" upper="{}" effort="1" velocity="{}"/>{}</joint>"""
GROUPS = """<robot name="hand"><group name="all"><joint name="motor"/><joint name="output"/><joint name="arm"/></group>
  <group name="free"><joint name="motor"/><joint name="arm"/></group></robot>"""


def scene(multiplier):
    mimic = f'<mimic joint="motor" multiplier="{multiplier}"/>' if multiplier else ''
    links = ''.join(LINK.format(name) for name in ('rotor', 'output_link', 'arm_link'))
    joints = JOINT.format('motor', 'base', 'rotor', 20, 20, 10, '')
    joints += JOINT.format('output', 'base', 'output_link', 0.1, 0.1, 0.2, mimic)
    joints += JOINT.format('arm', 'output_link', 'arm_link', 2, 2, 1, '')
    urdf = f'<robot name="hand"><link name="base"/>{links}{joints}</robot>'
    made = core.Scene('hand', core.loadUrdfSceneDescriptionFromXml(urdf))
    made.importSrdf(GROUPS)
    made.importJointLimitsFromConfig(core.loadJointLimitsConfig(sys.argv[1]))
    limits = made.getJointInfo('arm').limits
    assert limits.max_velocity == [1] and limits.max_acceleration == [2]
    return made


def move(made, group):
    """Give the time and the greatest speed and acceleration of the arm, which is the last joint, for 1.5 rad."""
    count = len(made.getJointGroupInfo(group).v_indices)
    path = core.JointPath()
    path.joint_names = made.getJointGroupInfo(group).joint_names
    path.positions = [np.zeros(count), np.append(np.zeros(count - 1), 1.5)]
    found = toppra.PathParameterizerTOPPRA(made, group).generate(path, toppra.TOPPRAOptions(dt=0.01))
    return found.times[-1], np.abs(found.velocities).max(0)[-1], np.abs(found.accelerations).max(0)[-1]


RIGHT = (1, 2, 2.08, 1, 2)
for multiplier, group, expected in (
    (5, 'all', (50, 50, 0.36, 8.56, 50)), (5, '', (50, 50, 0.36, 8.56, 50)), (5, 'free', RIGHT),
    (0.05, 'all', (0.5, 0.5, 4.16, 0.5, 0.5)), (None, 'all', RIGHT),
):
    made = scene(multiplier)
    limits = made.getVelocityLimitVectors(group)[1][-1], made.getAccelerationLimitVectors(group)[1][-1]
    found = (*limits, *move(made, group))
    print(f'multiplier {multiplier}, group {group!r}: limits of the arm {found[0]:.3g} rad/s, {found[1]:.3g} rad/s², '
          f'moved in {found[2]:.3g} s at {found[3]:.3g} rad/s and {found[4]:.3g} rad/s²')
    assert np.isclose(made.getPositionLimitVectors(group)[1][-1], 2)
    assert np.allclose(found, expected, rtol=0.03)
PYTHON
timeout 100 "$folder/venv/bin/python" "$folder/limits.py" "$folder/limits.yaml"

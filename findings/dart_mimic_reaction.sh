#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# dartpy 6.20.0: the mimic of a URDF takes its output along, but neither its inertia nor its load reaches the rotor.
#
# An output of 4 kg·m² is the mimic of a rotor of 0.01 kg·m², by -0.05. Expected: 0.01 N·m at the rotor turn it by 0.25
# rad in a second, and 0.2 N·m at the output turn it by -0.25 rad. What happens: 0.50 rad, as if there were no output,
# and 0 rad: the output is a servo that follows the rotor, with the effort of its limit. It holds 5 N·m at the output,
# and lets the output go under 20 N·m, while the rotor stands still. With setUseCouplerConstraint(True) at the output
# all is as expected.
# For us: call setUseCouplerConstraint(True) at each joint with a mimic, after loading.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check dartpy==6.20.0
cd "$folder"
cat > gear.urdf <<'URDF'
<robot name="gear">
  <link name="stator"/>
  <link name="rotor"><inertial><mass value="1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="shaft"><inertial><mass value="1"/><inertia ixx="4" iyy="4" izz="4" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="motor" type="continuous"><parent link="stator"/><child link="rotor"/><axis xyz="0 0 1"/></joint>
  <joint name="output" type="revolute"><parent link="stator"/><child link="shaft"/><axis xyz="0 0 1"/>
    <limit lower="-10" upper="10" effort="10" velocity="100"/><mimic joint="motor" multiplier="-0.05"/></joint>
</robot>
URDF
timeout 60 venv/bin/python - "$folder/gear.urdf" <<'PYTHON'
import sys

import dartpy


def turned(torque, load, coupler=False):
    loader, options = dartpy.utils.DartLoader(), dartpy.utils.DartLoaderOptions()
    options.mDefaultRootJointType = dartpy.utils.DartLoaderRootJointType.FIXED
    loader.setOptions(options)
    robot = loader.parseSkeleton(sys.argv[1])
    world = dartpy.simulation.World()
    world.addSkeleton(robot)
    world.setGravity([0, 0, 0])
    world.setTimeStep(0.001)
    motor, output = robot.getJoint('motor'), robot.getJoint('output')
    if coupler:
        output.setUseCouplerConstraint(True)
    for _ in range(1000):
        motor.setForce(0, torque)
        robot.getBodyNode('shaft').addExtTorque([0, 0, load])
        world.step()
    angles = motor.getPosition(0), output.getPosition(0)
    print(torque, 'and', load, 'N·m, coupler', coupler, 'rotor and output', angles)
    return angles


def near(angles, expected):
    return all(abs(angle - wanted) < 0.01 for angle, wanted in zip(angles, expected, strict=True))


assert near(turned(0.01, 0, coupler=True), (0.25, -0.0125))
assert near(turned(0, 0.2, coupler=True), (-0.25, 0.0125))
assert near(turned(0.01, 0), (0.5, -0.025))
assert near(turned(0, 5), (0, 0))
assert near(turned(0, 20), (0, (20 - 10) / 4 / 2))
PYTHON

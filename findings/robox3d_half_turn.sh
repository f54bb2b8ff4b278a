#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# robox3d 0.1.0: a rotor that is to turn to 4 rad spins for ever, and the mimic, damping and friction of a URDF have no
# effect.
#
# A continuous joint under position control with 10 N·m/rad and 0.6 N·m·s/rad. Expected of set_targets(), which goes to
# 4 rad at 2 rad/s: the rotor follows and stops, as it does at 3 rad. What happens: angles are kept within ±π, but not
# the goals; beyond half a turn the error never gets less than 0.86 rad, and the rotor is driven on. positions() goes
# from 3.14 to -3.14 rad, so that no count of turns is left for an encoder. The output of a <mimic> is a free joint that
# stays at 0, and a damping of 1 N·m·s/rad and a friction of 1 N·m in the URDF have no effect; no warning says so. The
# torque itself is right: 0.5 rad after a second.
# For us: keep a simulated joint within half a turn, or take the MJCF that gearkin writes.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check robox3d==0.1.0 yourdfpy==0.0.60 numpy==2.4.6
cd "$folder"
cat > gear.urdf <<'URDF'
<robot name="gear">
  <link name="stator"/>
  <link name="rotor"><inertial><mass value="1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="shaft"><inertial><mass value="1"/><inertia ixx="4" iyy="4" izz="4" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="motor" type="continuous"><parent link="stator"/><child link="rotor"/><axis xyz="0 0 1"/>
    <dynamics damping="1" friction="1"/></joint>
  <joint name="output" type="continuous"><parent link="stator"/><child link="shaft"/><axis xyz="0 0 1"/>
    <mimic joint="motor" multiplier="-0.05"/></joint>
</robot>
URDF
timeout 100 venv/bin/python -W error::UserWarning - <<'PYTHON'
import math

import robox3d

STEP = 1 / 240


def loaded():
    world = robox3d.World(gravity=(0, 0, 0))
    return world, robox3d.load_urdf(world, 'gear.urdf')


def follows(goal):
    """The turned angle and the speed 6 s after a goal that moves at 2 rad/s."""
    world, robot = loaded()
    robot.enable_position_control(kp=10, kd=0.6)
    turned = last = 0.0
    for step in range(round(6 / STEP)):
        robot.set_targets([min(goal, 2 * step * STEP), 0.0])
        world.step(STEP)
        angle = float(robot.positions()[0])
        turned += math.remainder(angle - last, 2 * math.pi)
        last = angle
    print(f'goal {goal} rad: has turned by {turned:.1f} rad, is shown at {angle:.2f} rad, {float(robot.velocities()[0]):.1f} rad/s')
    return turned, angle, float(robot.velocities()[0])


turned, angle, speed = follows(3.0)
assert abs(turned - 3) < 0.01 and abs(speed) < 0.01
turned, angle, speed = follows(4.0)
assert turned > 100 and abs(angle) <= math.pi and speed > 20

world, robot = loaded()
robot.enable_torque_control()
for _ in range(round(1 / STEP)):
    robot.set_torques([0.01, 0.0])
    world.step(STEP)
motor, output = map(float, robot.positions())
print(f'0.01 N·m for 1 s, against a friction of 1 N·m: motor {motor:.3f} rad, output {output:.3f} rad')
assert abs(motor - 0.5) < 0.01 and output == 0
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# MuJoCo 4.0.0: behind a gear of 20, a joint with limits of ±90° reaches only ±4.5° by a servo with inheritrange="1".
#
# A position actuator with gear="20" is given the angle of the rotor, which is 20 times that of the joint. Expected of
# inheritrange="1", which is to take the limits of the actuator from those of the joint: a ctrlrange of ±1800°, or an
# error. What happens: the ctrlrange is ±90°, without a warning, and a command of 1200° is cut to 90°, so that the joint
# goes to 4.5° instead of 60°. With a gear of -20 and a joint from 0° to 90°, the range is from 0° to 90° instead of
# from -1800° to 0°, and the joint does not move at all. The actrange of intvelocity is too small in the same way.
# For us: give ctrlrange as the limits of the joint times the gear, and turn them where the gear is negative.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mujoco==4.0.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import math

import mujoco

MODEL = """
<mujoco>
  <option gravity="0 0 0"/>
  <worldbody>
    <body>
      <joint name="joint" axis="0 0 1" range="{range}" damping="20"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
    </body>
  </worldbody>
  <actuator><position joint="joint" gear="{gear}" kp="{gain}" {limits}/></actuator>
</mujoco>
"""


def reached(gear, goal, limits='inheritrange="1"', joint_range='-90 90'):
    """Return the angle of the joint in degrees, 5 s after the goal of the joint was given to the rotor."""
    xml = MODEL.format(gear=gear, gain=100 / gear**2, range=joint_range, limits=limits)
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    data.ctrl[0] = math.radians(gear * goal)
    while data.time < 5:
        mujoco.mj_step(model, data)
    angle = math.degrees(data.qpos[0])
    print(f'gear {gear}, {limits}: goal {goal}°, joint at {angle:.2f}°, ctrlrange {model.actuator_ctrlrange[0]}')
    return angle


assert abs(reached(1, 60) - 60) < 0.1 and abs(reached(20, 60, '') - 60) < 0.1
assert abs(reached(20, 60) - 4.5) < 0.1
assert abs(reached(-20, 60, '', '0 90') - 60) < 0.1
assert abs(reached(-20, 60, joint_range='0 90')) < 0.1
xml = MODEL.format(gear=20, gain=1, range='-90 90', limits='inheritrange="1"').replace('position', 'intvelocity')
assert abs(mujoco.MjModel.from_xml_string(xml).actuator_actrange[0, 1] - math.radians(90)) < 1e-6
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# Pinocchio 4.1.0: the torque limit of a motor in an MJCF is lost: a joint that gets 20 N·m at most has no limit.
#
# A motor has forcerange="-1 1" and a gear of 20. Expected of effortLimit: 20 N·m, what MuJoCo 4.0.0 gives the joint at
# most, as the effort of a URDF becomes effortLimit, and as actuatorfrcrange="-20 20" of the joint, the other way to
# write this limit, does. What happens: it is infinite, also with ctrlrange, and for a position servo, without a
# warning, so that a plan or a feedforward within effortLimit cannot be followed. rotorGearRatio stays 1 as well.
# Damping, friction and armature of the joint are right.
# For us: set effortLimit after loading, forcerange times the gear.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pin==4.1.0 mujoco==4.0.0 numpy==2.4.6
cat > "$folder/motor.py" <<'PYTHON'
import sys

import mujoco
import numpy as np
import pinocchio as pin

MJCF = """<mujoco><worldbody><body name="arm">
  <joint name="joint" axis="0 0 1" damping="0.1" frictionloss="0.2" armature="0.4" {}/>
  <inertial pos="0 0 0" mass="1" diaginertia="0.1 0.1 0.1"/></body></worldbody><actuator>{}</actuator></mujoco>"""
MOTOR = '<motor joint="joint" gear="20" {}/>'
for joint, actuator, found in (
    ('', MOTOR.format('forcerange="-1 1"'), np.inf),
    ('', MOTOR.format('ctrlrange="-1 1"'), np.inf),
    ('', '<position joint="joint" gear="20" kp="10" forcerange="-1 1"/>', np.inf),
    ('actuatorfrcrange="-20 20"', MOTOR.format(''), 20),
):
    text = MJCF.format(joint, actuator)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.ctrl[0] = 1e3
    mujoco.mj_forward(model, data)
    with open(sys.argv[1], 'w') as file:
        file.write(text)
    read = pin.buildModelFromMJCF(sys.argv[1])
    print(f'{joint} {actuator}: {data.qfrc_actuator[0]} N·m in MuJoCo, effortLimit {read.effortLimit[0]} N·m')
    assert data.qfrc_actuator[0] == 20 and read.effortLimit[0] == found and read.rotorGearRatio[0] == 1
    assert (read.damping[0], read.friction[0], read.armature[0]) == (0.1, 0.2, 0.4)
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/motor.py" "$folder/motor.xml"

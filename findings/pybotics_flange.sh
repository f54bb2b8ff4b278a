#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pybotics 3.1.2: jacobian_flange() is that of the tool, 700 mm instead of 500 mm, and compute_joint_torques() that of
# the flange.
#
# An arm of 500 mm has a tool of 200 mm. Expected of jacobian_flange(), whose documentation names the flange frame: 500
# mm for each rad, and the torque of 1 N at the flange is its product with the force, 500 N·mm. What happens: it has 700
# mm, as the tool is in it, and compute_joint_torques() gives 500 N·mm for the same force, as the tool is not in it. A
# force that is measured at the tool gets torques that are 29 % too small, without a warning. Without a tool the two
# agree.
# For us: multiply the transposed jacobian_flange() by the force at the tool.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pybotics==3.1.2 numpy==1.26.4 scipy==1.15.3
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import numpy as np
from pybotics.robot import Robot

JOINT, FLANGE = [0, 0, 0, 0.0], [0, 500, 0, 0.0]
arm, straight, force = Robot.from_parameters(np.array([JOINT, FLANGE])), np.zeros(2), np.array([0, 1.0, 0, 0, 0, 0])
for length, expected in ((0, 500), (200, 700)):
    arm.tool.position = [length, 0, 0]
    tip = arm.fk(straight)[0, 3]
    jacobian = arm.jacobian_flange(straight)
    torque = arm.compute_joint_torques(force, straight)[0]
    print('tool', length, 'tip at', tip, 'mm, Jacobian', jacobian[1, 0], 'mm/rad, torque', torque, 'N·mm')
    assert abs(tip - (500 + length)) < 1e-9
    assert abs(jacobian[1, 0] - expected) < 1e-9
    assert abs((jacobian.T @ force)[0] - expected) < 1e-9
    assert abs(torque - 500) < 1e-9
PYTHON

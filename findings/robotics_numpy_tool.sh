#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# robotics-numpy 0.1.0: in the Jacobian of an arm a tool of 0.2 m is 0.4 m long, in its forward kinematics 0.2 m.
#
# A joint with a link of 0.5 m and a tool of 0.2 m moves the tip by 0.7 m for each rad. Expected: jacob0() is the
# derivative of fkine(). What happens: the frame that it starts from contains the tool already, and the tool is added
# again: it has 0.9 m/rad. Speeds and torques of a gripper are wrong by 29 % here. Without a tool the two agree.
# For us: make the tool a part of the last link, and leave `tool` as it is.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check robotics-numpy==0.1.0 numpy==2.4.6
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
from robotics_numpy.kinematics.jacobian import jacob0
from robotics_numpy.models import DHRobot, RevoluteDH
from robotics_numpy.transforms import SE3


def speeds(arm):
    moved = arm.fkine([1e-6]).t - arm.fkine([-1e-6]).t
    return jacob0(arm, [0.0])[1, 0], moved[1] / 2e-6


bare = DHRobot([RevoluteDH(a=0.5)])
with_tool = DHRobot([RevoluteDH(a=0.5)])
with_tool.tool = SE3.Trans(0.2, 0, 0)
in_link = DHRobot([RevoluteDH(a=0.7)])
for name, arm, expected in (('bare', bare, (0.5, 0.5)), ('with tool', with_tool, (0.9, 0.7)), ('in link', in_link, (0.7, 0.7))):
    jacobian, moved = speeds(arm)
    print(name, 'Jacobian', jacobian, 'm/rad, moved', moved, 'm/rad')
    assert abs(jacobian - expected[0]) < 1e-9 and abs(moved - expected[1]) < 1e-6
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pin-pink 4.4.0: the output of a gear jumps by 18° whenever its continuous rotor passes half a turn.
#
# A JointCouplingTask with ratios of 1 and 20 keeps motor + 20 output = 0 in the inverse kinematics, as its
# documentation says of the joint angles. Expected of a rotor that is driven to 7 rad: the output turns to -0.35 rad.
# What happens where the motor is of type continuous: its angle counts within ±π only, so that the output goes to -0.156
# rad, then within one step to +0.156 rad, and is at -0.037 rad at the end, without a warning. With a revolute motor
# that has wide limits it is at -0.35 rad. Only the more general LinearHolonomicTask is said to take a difference of
# configurations, which for a continuous joint lies within ±π.
# For us: make the rotor revolute, with limits beyond all of its turns.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --only-binary :all: pin-pink==4.4.0 pin==4.1.0 daqp==0.11.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
import pink
import pinocchio

URDF = """<robot name="gear">
  <link name="stator"/>
  <link name="rotor"/>
  <link name="arm"/>
  <joint name="motor" type="{kind}"><parent link="stator"/><child link="rotor"/><axis xyz="0 0 1"/>
    <limit lower="-100" upper="100" effort="1" velocity="100"/></joint>
  <joint name="output" type="revolute"><parent link="stator"/><child link="arm"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="100"/></joint>
</robot>"""


def outputs(kind):
    """The output's angles in rad while the rotor turns to 7 rad in 280 steps of 25 mrad."""
    model = pinocchio.buildModelFromXML(URDF.format(kind=kind))
    arm = pink.Configuration(model, model.createData(), pinocchio.neutral(model))
    gear = pink.tasks.JointCouplingTask(['motor', 'output'], [1.0, 20.0], 1000.0, arm)
    drive = pink.tasks.PostureTask(cost=1.0)
    angles = []
    for angle in np.linspace(0, 7, 281):
        drive.set_target(pinocchio.integrate(model, pinocchio.neutral(model), np.array([angle, -angle / 20])))
        for _ in range(3):
            arm.integrate_inplace(pink.solve_ik(arm, [drive, gear], 0.01, solver='daqp'), 0.01)
        angles.append(arm.q[-1])
    return np.array(angles)


right, wrong = outputs('revolute'), outputs('continuous')
print('revolute motor: output at', right[-1], 'rad, greatest step', np.ptp(np.diff(right)), 'rad')
print('continuous motor: output at', wrong[-1], 'rad, from', wrong.min(), 'to', wrong.max(), 'rad')
assert np.allclose(right, -np.linspace(0, 7, 281) / 20, atol=1e-3)
assert abs(wrong[-1] + (7 - 2 * np.pi) / 20) < 2e-3
assert abs(np.diff(wrong).max() - 2 * np.pi / 20) < 5e-3
PYTHON

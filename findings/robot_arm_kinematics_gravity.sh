#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# robot-arm-kinematics 1.0.2: gravity pulls sideways: a shoulder that bears 85 N·m has none, and the vertical joint
# below it has them.
#
# Its Doosan M0609, whose first axis is vertical, stretched out horizontally along x. Expected of
# get_gravity_torque(), "required joint torques to compensate for gravitational forces": the torques by which the
# energy of its own centres of mass grows, -85.5 N·m at the shoulder, and none at the first joint, in any position.
# What happens: gravity acts along -y of the base, so that the shoulder has 0 N·m and the vertical joint -85.5 N·m. If
# the arm is stretched out along y instead, all torques but 21 N·m at the vertical joint are 0. A tool of 5 kg that is
# set by set_tool_shape() changes nothing: its mass is never used.
# For us: compute gravity's torques with Pinocchio, from the URDF of the arm.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    robot_arm_kinematics==1.0.2 numba==0.68.1 numpy==1.26.4 scipy==1.17.1 matplotlib==3.10.8
cd "$folder"
export MPLBACKEND=Agg
timeout 280 venv/bin/python - > log <<'PYTHON' || { tail log; exit 1; }
import numpy as np
from robot_arm_kinematics.config.doosan_m0609 import DoosanM0609Config
from robot_arm_kinematics.core.robot import RobotArmKinematics

config = DoosanM0609Config()
robot = RobotArmKinematics(config)


def energy(angles):
    """The potential energy of the links in J, with z upwards."""
    frames = robot.get_link_matrix(angles)
    frames = frames[0] if isinstance(frames, tuple) else frames
    centres = [(frames[link] @ np.append(config.link_cog[link], 1))[2] for link in range(6)]
    return 9.81 * float(np.dot(config.masses[:6], centres))


def torques(first):
    """The torques that hold the arm, and those of the library, in N·m, with the arm stretched out."""
    angles = np.radians([first, 90.0, 0.0, 0.0, 0.0, 0.0])
    steps = 1e-6 * np.eye(6)
    right = np.array([(energy(angles + step) - energy(angles - step)) / 2e-6 for step in steps])
    found = robot.get_gravity_torque(angles)
    print(f'\n> first joint at {first}°: right {(right + 0.0).round(1) + 0.0}, found {(found + 0.0).round(1) + 0.0}')
    return right, found


right, found = torques(0.0)
assert abs(right[0]) < 1e-3 and np.isclose(right[1], -85.5, atol=0.1)
assert abs(found[1]) < 1e-3 and np.isclose(abs(found[0]), abs(right[1]), rtol=0.02)
_, aside = torques(90.0)
assert np.isclose(aside[0], 21.4, atol=0.1) and np.abs(aside[1:]).max() < 0.1
config.set_tool_shape(5.0, np.array([0.0, 0.0, 0.1]))
_, loaded = torques(0.0)
assert np.array_equal(loaded, found)
PYTHON
grep '^>' log

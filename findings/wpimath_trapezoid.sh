#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# wpimath 2026.2.2: a joint at 3 rad/s whose limit is lowered to 1 rad/s is to brake with 100 rad/s² within 20 ms, not
# with 2.
#
# TrapezoidProfile takes a greatest velocity of 1 rad/s and a greatest acceleration of 2 rad/s². Expected: from 3 rad/s
# it brakes to 1 rad/s in 1 s, as ruckig 0.19.4 does. What happens: the velocity is 1 rad/s at the first step, and the
# position goes on from there as if the joint had never been faster: the plan to 10 rad takes 10.25 s instead of 9.25 s.
# For us: give the greater of the limit and the present velocity as the limit until the joint is slow enough, or use
# ruckig.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check robotpy-wpimath==2026.2.2 ruckig==0.19.4
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from ruckig import InputParameter, Ruckig, Trajectory
from wpimath.trajectory import TrapezoidProfile

SPEED, LIMIT, ACCELERATION, STEP = 3.0, 1.0, 2.0, 0.02
profile = TrapezoidProfile(TrapezoidProfile.Constraints(LIMIT, ACCELERATION))
state = profile.calculate(STEP, TrapezoidProfile.State(0, SPEED), TrapezoidProfile.State(10, 0))

motion, trajectory = InputParameter(1), Trajectory(1)
motion.current_position, motion.current_velocity, motion.current_acceleration = [0.0], [SPEED], [0.0]
motion.target_position, motion.target_velocity, motion.target_acceleration = [10.0], [0.0], [0.0]
motion.max_velocity, motion.max_acceleration = [LIMIT], [ACCELERATION]
Ruckig(1).calculate(motion, trajectory)
position, velocity, _ = trajectory.at_time(STEP)
print('wpimath', state.position, 'rad', state.velocity, 'rad/s,', (SPEED - state.velocity) / STEP, 'rad/s²', profile.totalTime(), 's')
print('ruckig', position, 'rad', velocity, 'rad/s', trajectory.duration, 's')
assert abs((SPEED - velocity[0]) / STEP - ACCELERATION) < 1e-6
assert state.velocity == LIMIT
assert abs(profile.totalTime() - 10.25) < 1e-6
assert abs(trajectory.duration - 9.25) < 1e-6
assert abs(state.position - LIMIT * STEP) < 1e-9
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# frccontrol 2026.20: a short move of limited jerk to 0.3 rad ends at 0.22 rad, and one to 0.05 rad is an error.
#
# generate_s_curve_profile() has limits of 1 rad/s and 2 rad/s², with 0.2 s to the greatest acceleration. Expected: it
# ends at its goal. What happens: where the greatest velocity is not reached, the move is cut short: to 0.22 rad of 0.3,
# 0.36 of 0.45. A goal below 0.06 rad is a ValueError of math.sqrt(). A goal of 1 rad, which reaches 1 rad/s, ends at 1
# rad; ruckig 0.19.4 reaches all four.
# For us: plan short moves of limited jerk with ruckig, and check the last position of a profile.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check frccontrol==2026.20 numpy==2.4.6 ruckig==0.19.4
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
from frccontrol import generate_s_curve_profile
from ruckig import InputParameter, Ruckig, Trajectory

SPEED, ACCELERATION, RISE, STEP = 1.0, 2.0, 0.2, 0.001


def reached_by_ruckig(goal):
    motion, trajectory = InputParameter(1), Trajectory(1)
    motion.target_position = [goal]
    motion.max_velocity, motion.max_acceleration, motion.max_jerk = [SPEED], [ACCELERATION], [ACCELERATION / RISE]
    Ruckig(1).calculate(motion, trajectory)
    return trajectory.at_time(trajectory.duration)[0][0]


for goal, expected in ((1.0, 1.0), (0.45, 0.37), (0.3, 0.22)):
    _, positions, velocities, _ = generate_s_curve_profile(SPEED, ACCELERATION, RISE, STEP, goal)
    print('goal', goal, 'reached', positions[-1], 'at up to', max(velocities), 'ruckig', reached_by_ruckig(goal))
    assert abs(positions[-1] - expected) < 0.005
    assert abs(reached_by_ruckig(goal) - goal) < 1e-9
try:
    generate_s_curve_profile(SPEED, ACCELERATION, RISE, STEP, 0.05)
except ValueError as error:
    print('goal 0.05', error)
else:
    raise SystemExit(1)
assert abs(reached_by_ruckig(0.05) - 0.05) < 1e-9
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# interpolatepy 3.3.2: a trajectory of limited jerk jumps back by 17 mrad in the middle of a turn.
#
# DoubleSTrajectory rounds its duration to whole milliseconds, but not its phases. As its second half counts back from
# the end, the position jumps between the halves by the speed times up to 0.5 ms: by -0.0168 rad at 50 rad/s, by 0.1 at
# 300 rad/s. The velocities show nothing of it. A TrapezoidalTrajectory that is to stop from 2 rad/s
# within 0.1 rad, which is too short for 2 rad/s², gives no error, but an acceleration of 5 000 000 000 rad/s².
# For us: such a jump of a goal, seen at the rotor, looks like lost steps or a slipping coupling.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check interpolatepy==3.3.2 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from interpolatepy import DoubleSTrajectory, StateParams, TrajectoryBounds, TrapezoidalTrajectory, TrapezoidalTrajectoryParams

for goal, bounds, exact, jump in (
    (2 * np.pi, (50, 500, 20000), 2 * np.pi / 50 + 0.125, -0.01681),
    (100, (300, 3000, 100000), 100 / 300 + 0.13, 0.1),
):
    trajectory = DoubleSTrajectory(StateParams(0, goal), TrajectoryBounds(*bounds))
    times = np.linspace(0, trajectory.duration, 25101)
    position = np.array([trajectory.evaluate(time) for time in times])
    velocity = np.array([trajectory.evaluate_velocity(time) for time in times])
    step = times[1]
    surplus = np.diff(position) - step * (velocity[1:] + velocity[:-1]) / 2
    worst = np.argmax(np.abs(surplus))
    print('duration', trajectory.duration, 'instead of', exact, 'jump', surplus[worst], 'at', times[worst], 's')
    assert trajectory.duration == round(exact, 3) != exact
    assert abs(surplus[worst] - jump) < 1e-4
    assert abs(surplus[worst] - bounds[0] * (exact - trajectory.duration)) < 1e-4
    assert np.abs(np.diff(velocity)).max() < 0.1
at, duration = TrapezoidalTrajectory.generate_trajectory(TrapezoidalTrajectoryParams(q0=0, q1=0.1, v0=2, amax=2, vmax=3))
acceleration = max(abs(at(time)[2]) for time in np.linspace(0, duration, 1001))
print('acceleration', acceleration, 'where 2 is allowed')
assert acceleration > 1e9
PYTHON

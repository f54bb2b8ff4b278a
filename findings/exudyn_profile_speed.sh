#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# exudyn 1.13.6: a joint that speeds up, turns on and brakes by three profiles ends where it began, not 2 rad further.
#
# A trajectory has three profiles of 1 s each: 1 rad/s², 0 and -1 rad/s². Expected of ProfileLinearAccelerationsList, in
# which "coordinates and velocities are computed relative to values of previous profiles": the joint turns at 1 rad/s at
# 1.5 s, and rests at 2 rad after 3 s, as it does if the same accelerations are given in one list. What happens: each
# profile begins with a speed of 0. At 1 s the speed jumps from 1 rad/s to 0, the joint stands still for a second, and
# then it turns back, to 0 rad at -1 rad/s. There is no warning.
# For us: give all accelerations in one list, or let each profile begin and end at rest; and compare the speeds of the
# trajectory just before and after each of its GetTimes().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check exudyn==1.13.6 numpy==2.4.6
cat > "$folder/profiles.py" <<'PYTHON'
import numpy as np
from exudyn.robotics.motion import ProfileLinearAccelerationsList, ProfilePTP, Trajectory

ACCELERATIONS = (1.0, 0.0, -1.0)  # each for one second
TIMES = (0.5, 0.999, 1.001, 1.5, 2.5, 3.0)


def states(name, trajectory):
    """Return the positions and the speeds at the times."""
    assert trajectory.GetTimes()[-1] == 3
    found = np.array([trajectory.Evaluate(time)[:2] for time in TIMES])[:, :, 0]
    print(name, *(f'{time:g} s: {angle:.3f} rad, {speed:.3f} rad/s;' for time, (angle, speed) in zip(TIMES, found)))
    return found


three, one = Trajectory([0.0]), Trajectory([0.0])
for value in ACCELERATIONS:
    three.Add(ProfileLinearAccelerationsList([(0, [value]), (1, [value])]))
edges = [(0, 1), (1, 1), (1 + 1e-9, 0), (2, 0), (2 + 1e-9, -1), (3, -1)]
one.Add(ProfileLinearAccelerationsList([(time, [value]) for time, value in edges]))
right = [(0.125, 0.5), (0.499, 0.999), (0.501, 1), (1, 1), (1.875, 0.5), (2, 0)]
assert np.allclose(states('one list:', one), right, atol=1e-6)
found = [(0.125, 0.5), (0.499, 0.999), (0.5, 0), (0.5, 0), (0.375, -0.5), (0, -1)]
assert np.allclose(states('three profiles:', three), found, atol=1e-6)

resting = Trajectory([0.0])  # profiles that begin and end at rest follow each other rightly
for goal in (1.0, 3.0):
    resting.Add(ProfilePTP([goal], syncAccTimes=False, maxVelocities=[10], maxAccelerations=[4]))
assert np.allclose(resting.Evaluate(1.0)[:2], [[1], [0]]) and resting.GetFinalCoordinates()[0] == 3
PYTHON
timeout 100 "$folder/venv/bin/python" "$folder/profiles.py"

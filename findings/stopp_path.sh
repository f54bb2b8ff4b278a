#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# stopp 0.4: a joint that is to swing to 1 rad and back on the path of an arm stands still, and a detour is cut off.
#
# TimeParameterizePath() takes a path of points for each joint and gives a trajectory of limited jerk "for a given
# predefined path". Expected: it goes through the points. What happens: one joint gets a move from its first to its last
# point, and the others the same move in proportion to their own first and last points. A joint that is to go to 1 rad
# and back has the position 0 for 0.232 s, and one that is to make a detour of 0.5 rad and end where it began makes
# none, without an error. Only a straight path is kept, as that of the README's example. toppra 0.6.10 keeps all three.
# For us: such a trajectory can meet an obstacle that the path avoids; plan paths that are not straight with toppra.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check stopp==0.4 toppra==0.6.10
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import logging

import numpy as np
import stopp
import toppra
from toppra import algorithm, constraint

logging.disable(logging.WARNING)
SPEED, ACCELERATION, JERK = 6.0, 50.0, 800.0
along = np.linspace(0, 1, 31)


def ranges(path):
    robot = stopp.Robot(len(path), JERK, ACCELERATION, SPEED, d_max=ACCELERATION)
    trajectories = robot.TimeParameterizePath(np.array(path), interp_time_step=0.004)
    return [(joint.pos.min(), joint.pos.max()) for joint in trajectories], trajectories[0].t[-1]


def toppra_ranges(path):
    limit = np.full((len(path), 1), 1.0) * [-1, 1]
    limits = [constraint.JointVelocityConstraint(SPEED * limit), constraint.JointAccelerationConstraint(ACCELERATION * limit)]
    trajectory = algorithm.TOPPRA(limits, toppra.SplineInterpolator(along, np.array(path).T)).compute_trajectory()
    positions = trajectory(np.linspace(0, trajectory.duration, 1001))
    return list(zip(positions.min(axis=0), positions.max(axis=0)))


straight = [along, 0.5 * along]
swing = [np.sin(np.pi * along), 0.2 * along]
detour = [along, 0.5 * np.sin(np.pi * along)]
expected = {'straight': [(0, 1), (0, 0.5)], 'swing': [(0, 1), (0, 0.2)], 'detour': [(0, 1), (0, 0.5)]}
seen = {'straight': [(0, 1), (0, 0.5)], 'swing': [(0, 0), (0, 0.2)], 'detour': [(0, 1), (0, 0)]}
for name, path in (('straight', straight), ('swing', swing), ('detour', detour)):
    found, duration = ranges(path)
    print(name, 'stopp', np.round(found, 4).tolist(), 'rad in', round(duration, 3), 's, toppra', np.round(toppra_ranges(path), 4).tolist())
    assert np.allclose(found, seen[name], atol=1e-6)
    assert np.allclose(toppra_ranges(path), expected[name], atol=1e-3)
    if name == 'swing':
        assert abs(duration - 0.232) < 0.001
PYTHON

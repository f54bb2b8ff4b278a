#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# toppra 0.6.10: a trajectory exceeds its limit of acceleration by 22 %, and goes on after its end.
#
# A joint moves by 1 rad through 0.3 rad, with at most 1 rad/s and 1 rad/s². The trajectory that TOPPRA makes by
# default, by ParametrizeSpline, accelerates with 1.219 rad/s²; by ParametrizeConstAccel with 1.000 rad/s². A second
# after its end, where a loop that is late may evaluate it, the joint is at 0.485 rad, not at 1 rad.
# For us: give parametrizer='ParametrizeConstAccel' for motions of a bench, and clip the time to its duration.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check toppra==0.6.10
"$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
import toppra
from toppra.algorithm import TOPPRA
from toppra.constraint import JointAccelerationConstraint, JointVelocityConstraint

toppra.setup_logging('ERROR')
limits = [JointVelocityConstraint([[-1.0, 1.0]]), JointAccelerationConstraint([[-1.0, 1.0]])]
path = toppra.SplineInterpolator([0.0, 0.5, 1.0], [[0.0], [0.3], [1.0]])
for chosen, greatest in (({}, 1.219), ({'parametrizer': 'ParametrizeConstAccel'}, 1.0)):
    trajectory = TOPPRA(limits, path, **chosen).compute_trajectory(0, 0)
    times = np.linspace(0.0, trajectory.duration, 2001)
    acceleration = np.abs(trajectory(times, 2)).max()
    end, after = trajectory(trajectory.duration)[0], trajectory(trajectory.duration + 1)[0]
    print(chosen, 'acceleration', acceleration, 'position at the end', end, 'and 1 s later', after)
    assert abs(acceleration - greatest) < 1e-3
    assert abs(end - 1.0) < 1e-6 and after < 0.6
PYTHON

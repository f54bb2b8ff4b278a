#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# visual-kinematics 0.2.1: a flange that is to turn by 20°, from 170° to 190°, turns back by 340° on a linear path.
#
# RobotTrajectory.interpolate(motion='lin') between two poses at one place, for the arm of its README. Expected: 20°,
# the shortest rotation, by which it also measures the length of the path, with len_segs_rot. What happens: each of the
# three Euler angles goes from its first to its last value, here from 170° to -170°. The flange turns by 340°, and the
# last joint by 358°, while the length of the path is that of 20°, so that it turns 17 times too fast. From 100° to 120°
# it turns by 20°, and so do both with 'p2p'.
# For us: interpolate the rotation of a flange by SciPy's Slerp.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check visual-kinematics==0.2.1 numpy==2.4.6 scipy==1.17.1 \
    matplotlib==3.10.8
cd "$folder"
MPLBACKEND=Agg timeout 200 venv/bin/python - <<'PYTHON'
from math import degrees, pi, radians

import numpy as np
from visual_kinematics.Frame import Frame
from visual_kinematics.RobotSerial import RobotSerial
from visual_kinematics.RobotTrajectory import RobotTrajectory

ARM = RobotSerial(np.array([
    [0.163, 0, pi / 2, 0], [0, 0.632, pi, pi / 2], [0, 0.6005, pi, 0],
    [0.2013, 0, -pi / 2, -pi / 2], [0.1025, 0, pi / 2, 0], [0.094, 0, 0, 0],
]))


def turned(start, end, motion):
    frames = [
        Frame.from_euler_3(np.array([radians(angle), 0.1, pi / 2 + 0.2]), np.array([[0.5], [0.3], [0.6]]))
        for angle in (start, end)
    ]
    trajectory = RobotTrajectory(ARM, frames)
    joints, _ = trajectory.interpolate(40, motion=motion)
    poses = [ARM.forward(values) for values in joints]
    total = degrees(sum(pose.angle_to(after) for pose, after in zip(poses, poses[1:])))
    length = degrees(trajectory.len_segs_rot.sum())
    last = degrees(np.ptp(joints[:, 5]))
    print(f'{motion} from {start}° to {end}°: turned by {total:.1f}°, its length is {length:.1f}°, last joint {last:.1f}°')
    assert abs(length - 20) < 0.1 and np.linalg.norm(poses[-1].t_3_1 - frames[-1].t_3_1) < 1e-3
    return total


assert abs(turned(100, 120, 'lin') - 20) < 1
assert abs(turned(170, 190, 'lin') - 340) < 2
assert abs(turned(170, 190, 'p2p') - 20) < 5
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# robosuite 1.5.2: a flange that is half a turn from its goal has an orientation error of 0°, one at 90° of 57°, and a
# turn by 5° that may be up to 20° becomes -20°.
#
# Expected: orientation_error() of its impedance controllers gives "axis * angle" of the turn that is left, as
# documented; clip_rotation(), documented to limit a rotation, leaves one by 5° alone at a limit of 20°, whichever of
# its two quaternions is given; mat2euler() undoes euler2mat(), both documented to take or give (r, p, y).
# What happens: the error is the sine of the angle: it grows up to 90° only, is as small at 150° as at 30°, and is 0
# at 180°, so that a controller leaves a flange that is upside down as it is. clip_rotation() takes the quaternion of 5°
# with w < 0 as -355° and makes -20° of it, the wrong way. mat2euler(euler2mat()) of (60°, 40°, 30°) is (67.2°, -8.9°,
# 47.8°): one takes turned axes, the other fixed ones. With one angle both agree. A goal of OSC's interpolator with
# ori_interpolate="euler" goes through both, and ends at another attitude. No exception says so.
# Output: error at 30°, 90°, 150° and 180°: 28.6°, 57.3°, 28.6° and 0.0°
#         clipped at 20°: 5° by w > 0 is 5.0°, by w < 0 is -20.0°
#         (60°, 40°, 30°) becomes (67.2°, -8.9°, 47.8°), also as the goal of an interpolator
# For us: make w >= 0 before clip_rotation(), and take errors and Euler angles from another library.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check robosuite==1.5.2 mujoco==4.0.0 numpy==1.26.4
cd "$folder"
cat > turned.py <<'PYTHON'
import numpy as np
from robosuite.utils import transform_utils
from robosuite.utils.control_utils import orientation_error
from robosuite.utils.traj_utils import LinearInterpolator


def about_z(degrees):
    half = np.radians(degrees) / 2
    return np.array((0, 0, np.sin(half), np.cos(half)))


def degrees(values):
    return np.degrees(values).round(1) + 0.0


angles = (30, 90, 150, 180)
errors = [orientation_error(transform_utils.quat2mat(about_z(angle)), np.eye(3))[2] for angle in angles]
print('error at', *angles, 'degrees:', *degrees(errors))
assert np.allclose(degrees(errors), (28.6, 57.3, 28.6, 0))

clipped = []
for sign in (1, -1):
    quaternion, _ = transform_utils.clip_rotation(sign * about_z(5), np.radians(20))
    clipped.append(degrees(transform_utils.quat2axisangle(quaternion)[2]))
print('5 degrees, clipped at 20 degrees, by w > 0 and w < 0:', *clipped)
assert np.allclose(clipped, (5, -20))

goal = np.radians((60, 40, 30))
there = degrees(transform_utils.mat2euler(transform_utils.euler2mat(goal)))
alone = degrees(transform_utils.mat2euler(transform_utils.euler2mat(np.radians((60, 0, 0)))))
interpolator = LinearInterpolator(ndim=3, controller_freq=500, policy_freq=20, ramp_ratio=0.2, ori_interpolate='euler')
interpolator.set_goal(goal)
for _ in range(30):
    interpolated = interpolator.get_interpolated_goal()
print('60, 40, 30 degrees become', *there, 'and by an interpolator', *degrees(interpolated), 'and 60, 0, 0', *alone)
assert np.allclose(alone, (60, 0, 0), atol=0.1)
assert np.allclose(there, (67.2, -8.9, 47.8), atol=0.15) and np.allclose(there, degrees(interpolated), atol=0.2)
PYTHON
timeout 300 venv/bin/python turned.py 2> log || { cat log; exit 1; }

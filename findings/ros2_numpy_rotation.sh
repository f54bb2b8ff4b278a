#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# ros2-numpy 0.0.5: numpify() of a Pose or a Transform without any rotation is a half turn about z.
#
# Expected of numpify() of a Pose whose orientation is x, y, z, w = 0, 0, 0, 1: the matrix of no rotation. What
# happens: its four numbers are given in this order to the package transformations, which takes w first. So no
# rotation is a half turn about z, and 0.5 rad about z is a half turn about an axis 0.25 rad off z. msgify(Pose, matrix)
# writes w as x: of no rotation it makes a half turn about x. msgify(Transform, matrix) is right, so that a Transform
# does not come back as it was. Of several matrices at once it gives None. No error, no warning. The package asks for
# numpy 1.24.2, and does the same with a newer one, as here.
# For us: take scipy's Rotation.from_quat([x, y, z, w]).as_matrix().
#
# Exit code 0: still so. Installs the wheels into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check 'ros-jazzy-rclpy[fastrtps]==7.1.6' \
    ros-jazzy-geometry-msgs==5.3.6 ros-jazzy-sensor-msgs==5.3.6 ros-jazzy-nav-msgs==5.3.6 \
    numpy==2.4.6 pybase64 scipy==1.17.1 transformations==2026.1.18
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps ros2-numpy==0.0.5
export ROS_LOG_DIR="$folder/log"
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from geometry_msgs.msg import Pose, Quaternion, Transform
from ros2_numpy import msgify, numpify
from scipy.spatial.transform import Rotation


def turned(angle):
    return Quaternion(z=float(np.sin(angle / 2)), w=float(np.cos(angle / 2)))


def rotation_vector(matrix):
    return (Rotation.from_matrix(matrix[:3, :3]).as_rotvec() + 0.0).round(3).tolist()


for message in (Pose(orientation=turned(0.0)), Transform(rotation=turned(0.0))):
    matrix = numpify(message)
    print(type(message).__name__, 'without rotation', matrix.round(9).tolist())
    assert np.allclose(matrix, np.diag([-1, -1, 1, 1]))
axis = rotation_vector(numpify(Pose(orientation=turned(0.5))))
print('0.5 rad about z', axis)
tilt = np.arctan2(abs(axis[1]), abs(axis[2]))
assert abs(tilt - 0.25) < 1e-3 and axis[0] == 0 and abs(np.linalg.norm(axis) - np.pi) < 1e-3

none = np.eye(4)
pose, transform = msgify(Pose, none).orientation, msgify(Transform, none).rotation
print('back', pose, transform)
assert (pose.x, pose.w) == (1.0, 0.0) and (transform.x, transform.w) == (0.0, 1.0)
assert msgify(Pose, np.stack([none, none])) is None
PYTHON

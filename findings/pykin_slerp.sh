#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pykin 1.6.0: half way from 10° to 50° a flange is at -2°, and one that points straight down has no attitude.
#
# Expected of get_quaternion_slerp(), whose formula is the usual (qB·qA⁻¹)^t·qA: half way from 10° to 50° about z, 30°.
# What happens: the products and the power are taken number by number, not as those of quaternions: -2.0°, and -10° at
# the start itself, -0.4° at the goal. Half way between equal attitudes of 30° is -8.2°. The length is not 1, but 0.95.
# Expected of get_quaternion_from_matrix() for a flange that points straight down, a half turn about x: (0, 1, 0, 0).
# What happens: (0, 0, 0, 0), as the signs come from differences that are 0 there. The goal of the inverse kinematics of
# an arm goes through it if it is given as a matrix. With a matrix that has rounding errors it is right, or NaN.
# For us: take SciPy's Rotation and Slerp.
#
# Exit code 0: still so. Installs the versions into a temporary folder, and loads the one module of it, which needs only
# numpy, and a name of the standard library as it was before Python 3.10.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps pykin==1.6.0
cat > "$folder/slerp.py" <<'PYTHON'
import collections
import collections.abc
import importlib.metadata
import importlib.util

import numpy as np

collections.Iterable = collections.abc.Iterable
place = importlib.metadata.distribution('pykin').locate_file('pykin/utils/transform_utils.py')
spec = importlib.util.spec_from_file_location('transform_utils', place)
utils = importlib.util.module_from_spec(spec)
spec.loader.exec_module(utils)


def about_z(degrees):
    return utils.get_quaternion_from_rpy([0, 0, np.deg2rad(degrees)])


for start, goal, part, expected in (10, 50, 0.5, -2.02), (10, 50, 0, -10), (10, 50, 1, -0.41), (30, 30, 0.5, -8.21):
    found = utils.get_quaternion_slerp(about_z(start), about_z(goal), part)
    length = np.linalg.norm(found)
    angle = np.rad2deg(utils.get_rpy_from_quaternion(found / length)[2])
    print(f'{part} of the way from {start}° to {goal}°: {angle:.2f}°, length {length:.2f}')
    assert np.isclose(angle, expected, atol=0.01)
    assert np.isclose(np.rad2deg(utils.get_rpy_from_quaternion(about_z(start))[2]), start)

down = utils.get_quaternion_from_matrix(np.diag([1.0, -1.0, -1.0]))
turned = utils.get_quaternion_from_matrix(utils.get_matrix_from_rpy(np.deg2rad([179, 0, 0])))
print('straight down:', down, 'at 179°:', turned.round(4))
assert not down.any() and np.allclose(turned, (0.0087, 1, 0, 0), atol=1e-3)
pose = utils.get_pose_from_homogeneous(utils.get_h_mat([0, 0, 1.0], np.diag([1.0, -1.0, -1.0])))
print('pose:', pose)
assert np.array_equal(pose, (0, 0, 1, 0, 0, 0, 0))
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/slerp.py"

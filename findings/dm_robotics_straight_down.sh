#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# dm-robotics-transformations 0.10.0: by ZYZ angles, a flange that points straight down is turned by half a turn.
#
# The angles of many wrists and controllers are those about z, y and z. At a second angle of 180° only the difference of
# the other two is known, so that one of them is set to 0. Expected of rmat_to_euler() and euler_to_rmat() with 'ZYZ':
# the same rotation again, so (30°, 180°, 0°) for a flange at (30°, 180°, 0°). What happens: the first angle is -150°,
# and the flange that is made of the angles is half a turn away, for 357 of 359 angles about z, also by quat_to_euler().
# Its matrix has the opposite sign of what is taken from it there. At 179.9°, at 0° and with 'ZXZ' they are right.
# For us: compare the rotation that is made of ZYZ angles with the one that they were taken from, or take SciPy's.
#
# Exit code 0: still so. Installs the versions into a temporary folder, without jax, which this part does not use.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 scipy==1.17.1 absl-py==2.5.0
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps dm-robotics-transformations==0.10.0
cat > "$folder/flange.py" <<'PYTHON'
import logging

import numpy as np
from dm_robotics.transformations import transformations
from scipy.spatial.transform import Rotation

logging.disable()


def again(angles, order):
    """Give the angles in degrees that are read of a rotation, and how far their rotation is away from it in degrees."""
    flange = Rotation.from_euler(order, angles, degrees=True)
    rotation = transformations.euler_to_rmat(np.deg2rad(angles), order)
    assert np.allclose(rotation, flange.as_matrix())
    read = transformations.rmat_to_euler(rotation, order)
    made = Rotation.from_matrix(transformations.euler_to_rmat(read, order))
    return np.rad2deg(read), np.rad2deg((made.inv() * flange).magnitude())


for angles, order, away in (
    ((30, 180, 0), 'ZYZ', 180), ((30, 180, 20), 'ZYZ', 180), ((30, 179.9, 20), 'ZYZ', 0), ((30, 0, 20), 'ZYZ', 0),
    ((30, 180, 20), 'ZXZ', 0),
):
    read, found = again(angles, order)
    print(f'{order} {angles}: read as {read.round(3)}, {found:.3f}° away')
    assert np.isclose(found, away, atol=1e-4)

wrong = 0
for angle in range(-179, 180):
    half = np.deg2rad(angle) / 2
    quaternion = np.array([0, np.cos(half), np.sin(half), 0])
    flange = Rotation.from_quat(np.roll(quaternion, -1))
    made = Rotation.from_euler('ZYZ', transformations.quat_to_euler(quaternion, 'ZYZ'))
    wrong += (made.inv() * flange).magnitude() > 0.1
    assert (Rotation.from_euler('ZYZ', flange.as_euler('ZYZ')).inv() * flange).magnitude() < 1e-6
print(f'straight down, by quaternions: {wrong} of 359 wrong')
assert wrong > 300
PYTHON
timeout 60 "$folder/venv/bin/python" -W ignore "$folder/flange.py"

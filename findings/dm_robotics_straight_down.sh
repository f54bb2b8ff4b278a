#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# dm-robotics-transformations 0.10.0: by ZYZ angles, a flange that points straight down is turned by half a turn.
#
# The angles of many wrists and controllers are those about z, y and z. At a second angle of 180° only the difference of
# the other two is known, so that one of them is set to 0. Expected of rmat_to_euler() and euler_to_rmat() with 'ZYZ':
# the same rotation again, so (30°, 180°, 0°) for a flange at (30°, 180°, 0°). What happens: the first angle is -150°,
# and the flange that is made of the angles is half a turn away, for each of 359 angles about z. The numbers of the
# matrix that the angle is taken from have a minus there, which is left out. By quat_to_euler(), 333 of the 359 are half
# a turn away, and none is right to 1°. With a second angle of 179.9° or 0°, and with 'ZXZ', all is right.
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
import numpy as np
from dm_robotics.transformations import transformations
from scipy.spatial.transform import Rotation


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

by_matrix, by_quaternion = [], []
for angle in range(-179, 180):
    by_matrix.append(again((angle, 180, 0), 'ZYZ')[1])
    half = np.deg2rad(angle) / 2
    quaternion = np.array([0, np.cos(half), np.sin(half), 0])
    flange = Rotation.from_quat(np.roll(quaternion, -1))
    made = Rotation.from_euler('ZYZ', transformations.quat_to_euler(quaternion, 'ZYZ'))
    by_quaternion.append(np.rad2deg((made.inv() * flange).magnitude()))
    assert (Rotation.from_euler('ZYZ', flange.as_euler('ZYZ')).inv() * flange).magnitude() < 1e-6
assert np.allclose(by_matrix, 180, atol=1e-4)
half_turns = np.count_nonzero(np.isclose(by_quaternion, 180, atol=1e-4))
print(f'straight down, by quaternions: {half_turns} of 359 half a turn away, all at least {min(by_quaternion):.3g}°')
assert half_turns > 300 and min(by_quaternion) > 1
PYTHON
timeout 60 "$folder/venv/bin/python" -W ignore "$folder/flange.py"

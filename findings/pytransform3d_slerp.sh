#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pytransform3d 3.17.0: half way between 0° and 20° is 170°, where a sensor gives the quaternion with the other sign.
#
# Expected of quaternion_slerp(): 10°, as q and -q are one orientation, and sensors and libraries give either. What happens: its
# default shortest_path=False goes the long way round, by 340°. numpy-quaternion 2024.0.13, pyquaternion 0.9.9 and
# transformations 2026.1.18 give 10°, and so does SciPy 1.17.1's Slerp.
# For us: a pose that is played back between two samples spins once round; pass shortest_path=True.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pytransform3d==3.17.0 \
    numpy-quaternion==2024.0.13 pyquaternion==0.9.9 transformations==2026.1.18 scipy==1.17.1 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
import quaternion
import transformations
from pyquaternion import Quaternion
from pytransform3d.rotations import quaternion_slerp
from scipy.spatial.transform import Rotation, Slerp

start = np.array([1.0, 0.0, 0.0, 0.0])
end = -np.array([np.cos(np.radians(10)), 0.0, 0.0, np.sin(np.radians(10))])
scipy_end = Rotation.from_quat([0.0, 0.0, end[3], end[0]])
halves = {
    'pytransform3d': quaternion_slerp(start, end, 0.5),
    'shortest_path': quaternion_slerp(start, end, 0.5, shortest_path=True),
    'numpy-quaternion': quaternion.as_float_array(
        quaternion.slerp(quaternion.from_float_array(start), quaternion.from_float_array(end), 0, 1, 0.5)
    ),
    'pyquaternion': Quaternion.slerp(Quaternion(start), Quaternion(end), 0.5).elements,
    'transformations': transformations.quaternion_slerp(start, end, 0.5),
    'SciPy': Slerp([0, 1], Rotation.concatenate([Rotation.identity(), scipy_end]))(0.5).as_quat(scalar_first=True),
}
for name, half in halves.items():
    angle = np.degrees(2 * np.arccos(min(1.0, abs(half[0]))))
    print(name, round(angle, 6))
    assert abs(angle - (170 if name == 'pytransform3d' else 10)) < 1e-6
PYTHON

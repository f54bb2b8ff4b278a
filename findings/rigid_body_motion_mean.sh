#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rigid-body-motion 0.9.3: the mean of five attitudes of an output at 120° is a half turn about another axis, and the
# best rotation between markers in one plane is often wrong.
#
# Expected of qmean(), which is to be the eigenvector of the greatest eigenvalue: of an output that is read five times
# between 118° and 122° about z, the attitude at 120°. What happens: it takes the first eigenvector of NumPy, and puts
# its four numbers into the order of the eigenvalues: a half turn about an axis in the plane of x and z. At 30° it is
# right by luck, as the eigenvalues come in their order. Of 100 random attitudes that are read 20 times with a noise of
# about 1°, about two thirds of the means are off by more than 0.1 rad.
# Expected of best_fit_rotation() for four markers on a flange, in one plane to 0.1 mm, that has turned by 30° about z:
# this turn. What happens: with a noise of 1 mm in the measured positions, it is off by more than 0.1 rad for about half
# of the measurements, as it takes a reflection for a rotation. best_fit_transform() is right for each of them.
# For us: take SciPy's Rotation.mean() and Rotation.align_vectors(), which are right here.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check rigid-body-motion==0.9.3 numpy==2.4.6 \
  scipy==1.17.1 numpy-quaternion==2024.0.13 anytree==2.13.0
cat > "$folder/mean.py" <<'PYTHON'
import numpy as np
import rigid_body_motion as motion
from scipy.spatial.transform import Rotation


def as_quaternion(rotation):
    """Give w, x, y, z of a rotation."""
    return np.roll(rotation.as_quat(), 1, axis=-1)


def away(found, rotation):
    """Give the angle in rad between a quaternion that was found and the right rotation."""
    return (Rotation.from_quat(np.roll(found, -1)).inv() * rotation).magnitude()


def about_z(degrees):
    return Rotation.from_rotvec(np.outer(np.deg2rad(degrees), (0, 0, 1)))


for angle in 30, 120:
    readings = about_z(angle + np.arange(-2, 3))
    found = motion.qmean(as_quaternion(readings), axis=0)
    print(f'output at {angle}°: mean {found.round(3)}, SciPy {as_quaternion(readings.mean()).round(3)}')
    assert away(as_quaternion(readings.mean()), about_z([angle])[0]) < 1e-6
    assert (away(found, about_z([angle])[0]) < 1e-6) == (angle == 30)
    assert angle == 30 or abs(found[0]) < 1e-6

random = np.random.default_rng(1)
wrong = right = 0
for attitude in Rotation.random(100, rng=random):
    readings = attitude * Rotation.from_rotvec(random.normal(0, 0.02, (20, 3)))
    wrong += away(motion.qmean(as_quaternion(readings), axis=0), attitude) > 0.1
    right += away(as_quaternion(readings.mean()), attitude) < 0.1
print(f'mean of 20 readings: wrong for {wrong} of 100 attitudes, right by SciPy for {right}')
assert wrong > 50 and right == 100

turn = about_z([30])[0]
markers = np.array([(0.1, 0, 0), (0, 0.1, 0), (-0.1, 0, 0), (0, -0.1, 0)])
wrong = right = 0
for _ in range(100):
    before = markers + random.normal(0, 1e-4, (4, 3))
    after = turn.apply(markers) + random.normal(0, 1e-3, (4, 3))
    wrong += away(motion.best_fit_rotation(before, after), turn) > 0.1
    right += away(motion.best_fit_transform(before, after)[1], turn) < 0.1
    assert away(as_quaternion(Rotation.align_vectors(after, before)[0]), turn) < 0.1
print(f'rotation of four markers: wrong for {wrong} of 100 measurements, right by best_fit_transform() for {right}')
assert 30 < wrong < 70 and right == 100
PYTHON
timeout 60 "$folder/venv/bin/python" -W ignore "$folder/mean.py"

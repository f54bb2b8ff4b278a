#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# liecasadi 0.0.7: a flange that points straight down, a half turn about x, is read as not turned at all.
#
# Expected of SO3.from_matrix() and SE3.from_matrix(): as_matrix() gives the matrix back, as it does of a turn by 179°.
# What happens: of each half turn about x, y or z, such as diag(1, -1, -1), the quaternion is (0, 0, 0, 0), and its
# matrix the identity, without an error; a tool 0.2 m in front of such a flange is put 0.4 m too high. The signs of x, y
# and z are those of differences in the matrix, which are 0 in a half turn. The numbers under its roots may also be just
# below 0: of 1000 products of three turns about z, about 50 are NaN. And the difference of two rotations is not the
# shortest one, although both quaternions have w > 0: from 170° to -170° it is -340° instead of 20°, and slerp() turns
# through 0°.
# For us: give SciPy's Rotation.from_matrix(m).as_quat() to SO3.from_quat(), and change the sign of one of two
# quaternions whose dot product is negative before a difference or a slerp.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check liecasadi==0.0.7 casadi==3.8.2 numpy==2.4.6
cat > "$folder/turns.py" <<'PYTHON'
import casadi
import numpy as np
from liecasadi import SE3, SO3


def number(value):
    return np.array(casadi.DM(value)).squeeze()


def about_z(angle):
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])


near = number(SO3.from_euler(np.radians([179, 0, 0])).as_matrix())
assert np.allclose(number(SO3.from_matrix(near).as_matrix()), near)
for diagonal in ((1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0)):
    turn = SO3.from_matrix(np.diag(diagonal))
    print('half turn', diagonal, 'quaternion', number(turn.as_quat().coeffs()))
    assert not number(turn.as_quat().coeffs()).any() and np.array_equal(number(turn.as_matrix()), np.eye(3))

flange = np.diag((1.0, -1.0, -1.0, 1.0))
flange[:3, 3] = 0.5, 0.0, 0.6
tool = number(SE3.from_matrix(flange).as_matrix()) @ (0, 0, 0.2, 1)
print('tool', tool[:3], 'expected', (flange @ (0, 0, 0.2, 1))[:3])
assert np.allclose(tool[:3], (0.5, 0, 0.8)) and np.allclose((flange @ (0, 0, 0.2, 1))[:3], (0.5, 0, 0.4))

random = np.random.default_rng(1)
angles = random.uniform(-3, 3, (1000, 3))
products = [about_z(one) @ about_z(two) @ about_z(three) for one, two, three in angles]
invalid = sum(np.isnan(number(SO3.from_matrix(product).as_quat().coeffs())).any() for product in products)
print('products of three turns that are NaN:', invalid)
assert 10 < invalid < 200

degrees = {}
for begin, end in ((10, 30), (-20, 20), (170, -170)):
    one, other = (SO3.from_euler(np.radians([0, 0, angle])) for angle in (begin, end))
    assert all(number(given.as_quat().coeffs())[3] > 0 for given in (one, other))
    middle = number(SO3.slerp(one, other, 3)[1].as_euler())[2]
    degrees[begin] = *np.degrees([number((other - one).vec)[2], middle]).round(6),
    print(f'from {begin}° to {end}°: by {degrees[begin][0]}°, half way at {degrees[begin][1]}°')
assert degrees == {10: (20, 20), -20: (40, 0), 170: (-340, 0)}
PYTHON
timeout 200 "$folder/venv/bin/python" "$folder/turns.py"

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# poekit 0.1.0: the mass matrix of an arm is that of the stretched arm at any angle of its elbow, and a yaw of 0.5 rad
# is -0.5 rad.
#
# An arm with two joints about z and two links of 1 m, each of 1 kg and 0.1 kg·m² about its middle, with its elbow at 2
# rad. Expected of InertiaUtils.M_inertia_Aij(), by the angles that it is given: 1.284 kg·m² at the shoulder. What
# happens: 2.700 kg·m², those of the stretched arm, also at any other angle of the elbow, as the joints between two
# links are counted one too low. M_inertia_Jsl() is to give the same matrix and has 2.350 kg·m² at the shoulder and 0 at
# the elbow. N_potential_Aij() counts alike: with the shoulder at 0.3 rad, gravity has 4.69 N·m at the elbow instead of
# -3.27 N·m. Expected of RotationUtils.eul_2_rotm([0.5, 0, 0]), whose default is ZYX: x turns towards y, as with 'XYZ'
# and 'ZYZ'. What happens: it turns away, the matrix is transposed in this order alone. quat_to_eulZYX() is right.
# For us: take the mass matrix of a gear's load from another library, and transpose the matrix of ZYX.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check poekit==0.1.0 numpy==2.4.6 sympy==1.14.0
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
from math import cos, isclose

import numpy as np
from poekit import InertiaUtils, PotentialUtils, RotationUtils, TwistUtils

LINKS = np.array([[0.5, 0, 0, 0.1, 0.1, 0.1, 1], [1.5, 0, 0, 0.1, 0.1, 0.1, 1]]).T  # centre, inertia, mass
TWISTS = np.array([TwistUtils.joint_2_twist([0, 0, 1], place, 'rot') for place in ([0, 0, 0], [1, 0, 0])]).T
for shoulder, elbow in ((0.0, 0.0), (0.3, 2.0), (1.0, -1.0)):
    joints = np.vstack([TWISTS, [shoulder, elbow]])
    mass = InertiaUtils.M_inertia_Aij(joints, LINKS)
    other = InertiaUtils.M_inertia_Jsl(joints, LINKS)
    gravity = PotentialUtils.N_potential_Aij(joints, LINKS, np.array([0, -9.81, 0]))
    shoulder_inertia = 2 * 0.1 + 0.5**2 + 1 + 0.5**2 + 2 * 0.5 * cos(elbow)
    load = 9.81 * 0.5 * cos(shoulder + elbow)
    print(f'elbow at {elbow}: inertia at the shoulder {mass[0, 0]:.3f} and {other[0, 0]:.3f}, right {shoulder_inertia:.3f};'
          f' at the elbow {mass[1, 1]:.3f} and {other[1, 1]:.3f}; gravity at the elbow {gravity[1]:.3f}, right {load:.3f}')
    assert isclose(mass[0, 0], 2.7) and isclose(other[0, 0], 2.35) and other[1, 1] == 0
for order, sign in (('ZYX', -1), ('ZYZ', 1), ('XYZ', 1)):
    angles = [0, 0, 0.5] if order == 'XYZ' else [0.5, 0, 0]
    turned = RotationUtils.eul_2_rotm(angles, order)
    print(order, 'turns x by', np.arctan2(turned[1, 0], turned[0, 0]))
    assert isclose(np.arctan2(turned[1, 0], turned[0, 0]), sign * 0.5)
assert np.allclose(RotationUtils.quat_to_eulZYX([np.cos(0.25), 0, 0, np.sin(0.25)]), [0.5, 0, 0])
PYTHON

#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# satellogic_quaternions 0.1.8: five attitudes of an output between 189° and 191° have a standard deviation of 321°.
#
# A Quaternion of this package is an attitude, so that q and -q are equal, also by ==. Expected of
# average_and_std_naive() for an output that is read at 189°, 189.5°, 190°, 190.5° and 191° about z: 190° and a standard
# deviation of 0.707°, as at 29° to 31°. What happens: 321.3°, and the same at 300° and 350°: from_rotation_vector()
# makes quaternions with a negative real part there, that of the average is made positive, and the distance between the
# two signs is taken as nearly a whole turn. The average is right. The package says elsewhere, of positive_representant,
# that one sign has to be chosen for a distance, as distance() of 10° and 12° is 2° or 358°; this function does not do
# it. With positive_representant of each reading, 190° is right, but not 180.2°. average_and_std_lerner() gives the same
# at all angles.
# For us: take the lesser one of distance() and 2π - distance().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 satellogic-quaternions==0.1.8
cat > "$folder/deviation.py" <<'PYTHON'
import numpy as np
from quaternions import Quaternion


def about_z(degrees):
    return Quaternion.from_rotation_vector([0, 0, np.deg2rad(degrees)])


lerner = []
for angle, expected in (30, 0.707), (179, 0.707), (190, 321.3), (300, 321.3), (350, 321.3):
    readings = [about_z(angle + noise) for noise in (-1, -0.5, 0, 0.5, 1)]
    average, deviation = Quaternion.average_and_std_naive(*readings)
    lerner.append(Quaternion.average_and_std_lerner(*readings)[1])
    print(f'output at {angle}°: standard deviation {deviation:.4g}°, by Lerner {lerner[-1]:.4g}°')
    assert average == about_z(angle) and np.isclose(deviation, expected, rtol=1e-3)
assert np.allclose(lerner, lerner[0])

for angle, expected in (190, 0.707), (180.2, 227.2):
    readings = [about_z(angle + noise).positive_representant for noise in (-1, -0.5, 0, 0.5, 1)]
    deviation = Quaternion.average_and_std_naive(*readings)[1]
    print(f'output at {angle}°, positive representants: {deviation:.4g}°')
    assert np.isclose(deviation, expected, rtol=1e-3)

goal = about_z(12)
ways = [np.rad2deg(about_z(10).distance(quaternion)) for quaternion in (goal, -goal)]
print(f'from 10° to 12°: {ways[0]:.6g}° and {ways[1]:.6g}°')
assert goal == -goal and np.allclose(goal.matrix, (-goal).matrix) and np.allclose(ways, (2, 358))
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/deviation.py"

#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# attipy 0.0.7: an IMU at rest turns by 57.3° because another one, that began at the same attitude, turns by 57.3°.
#
# Two IMUs, at the output of an actuator and at its housing, are given the same initial attitude, an Attitude of no
# rotation, and one AHRS each. The output turns about the vertical axis at 1 rad/s for 1 s, and the housing is at rest.
# Expected: yaws of 57.3° and 0°. What happens: 57.3° for both, as each AHRS takes the object that it is given for its
# own state and turns it in place, so that both have one state. The initial attitude of the caller is at 57.3° then,
# too, so that an AHRS that is made of it later begins there. The same happens with one quaternion in a numpy array.
# The documentation calls it the initial attitude estimate, and its examples give an Attitude. A tuple is right.
# For us: give tuple(attitude.as_quaternion()) to each AHRS.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check attipy==0.0.7 numpy==2.3.5 scipy==1.17.1
cat > "$folder/yaws.py" <<'PYTHON'
import numpy as np
from attipy import AHRS, Attitude


def yaw(quaternion):
    return np.rad2deg(2 * np.arctan2(quaternion[3], quaternion[0]))


def yaws(start):
    """Give the yaws in degrees of an output that turns at 1 rad/s for 1 s, and of a housing at rest."""
    output, housing = AHRS(100, start), AHRS(100, start)
    for _ in range(101):
        output.update((0, 0, -9.80665), (0, 0, 1.0))
        housing.update((0, 0, -9.80665), (0, 0, 0))
    return yaw(output.q_nb), yaw(housing.q_nb)


start = Attitude((1.0, 0.0, 0.0, 0.0))
shared = yaws(start)
print('yaws, both begun at one Attitude:', shared)
after = yaw(AHRS(100, start).q_nb)
print('the initial attitude after that:', after)
apart = yaws((1.0, 0.0, 0.0, 0.0))
print('yaws, both begun at one tuple:', apart)
assert np.allclose(yaws(np.array((1.0, 0.0, 0.0, 0.0))), shared)
assert np.allclose(yaws(tuple(Attitude((1.0, 0.0, 0.0, 0.0)).as_quaternion())), apart)
assert np.allclose(shared, np.rad2deg(1), atol=0.1) and np.isclose(after, np.rad2deg(1), atol=0.1)
assert np.allclose(apart, (np.rad2deg(1), 0), atol=0.1)
PYTHON
timeout 250 "$folder/venv/bin/python" -W ignore "$folder/yaws.py"

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# spatialmath-python 1.1.18: the elevation of an arm whose shoulder has turned to 190° is -170° instead of -10°, and at
# 370° it is -350°.
#
# Expected of wrap_mpi2_pi2(), documented to fold an angle, as that of a latitude, into [-90°, 90°]: the angle from -90°
# to 90° that has the same sine, for any angle, as wrap_0_pi() gives the one from 0° to 180° with the same cosine.
# What happens: it is so between -180° and 180°. Beyond them the result is far out of the range: 185° gives -175°, 270°
# gives 270° and 370° gives -350°, as each quarter turn, instead of each half turn, takes half a turn away. The sine is
# right, but the sign and the size of the elevation are not. No exception says so.
# Output: -100 to -80, 100 to 80, 170 to 10, 185 to -175, 190 to -170, 270 to 270, 370 to -350 degrees
# For us: take asin(sin(angle)).
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check spatialmath-python==1.1.18 numpy==2.4.6
cd "$folder"
timeout 120 venv/bin/python - <<'PYTHON'
from math import asin, cos, degrees, pi, radians, sin

from spatialmath.base import wrap_0_pi, wrap_mpi2_pi2, wrap_mpi_pi

folded = {-100: -80, 100: 80, 170: 10, 185: -175, 190: -170, 270: 270, 370: -350}
for angle, seen in folded.items():
    result = degrees(wrap_mpi2_pi2(radians(angle)))
    expected = degrees(asin(sin(radians(angle))))
    wrapped = degrees(wrap_mpi2_pi2(wrap_mpi_pi(radians(angle))))
    print(angle, 'to', round(result, 6), 'expected', round(expected, 6), 'wrapped before', round(wrapped, 6))
    assert abs(result - seen) < 1e-6
    assert abs(wrapped - expected) < 1e-6
    assert (abs(result - expected) < 1e-6) == (abs(angle) < 180)
    other = wrap_0_pi(radians(angle))
    assert 0 <= other <= pi and abs(cos(other) - cos(radians(angle))) < 1e-9
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pybearing 1.0.4: at an output that turns at 0.1 rpm the cage frequency is 5 % too large, and one that turns back is an
# error.
#
# Expected: the fault frequencies of a bearing are proportional to the speed. What happens: the speed in Hz is rounded
# to four decimals, and so is each frequency: right to 1e-6 at 1500 rpm, but at 0.1 rpm the frequency of the outer ring
# is 2 % too large and that of the cage 5 %, and at 0.02 rpm it is 25 % too small. Below 0.006 rpm, at rest, and at a
# negative speed an error says that the cage frequency must be positive.
# For us: compute the orders once, at 60 rpm, and multiply them by the speed of the joint.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pybearing==1.0.4 numpy==2.4.6 scipy==1.17.1
timeout 100 "$folder/venv/bin/python" - <<'PYTHON'
from pybearing.analysis.fault_frequencies_analysis import calculate_from_geometry
from pybearing.core.bearing import Bearing

bearing = Bearing('6205', d=25, D=52, B=15, D_b=7.94, D_m=39.04, theta=0.0, N_b=9)
slip = 1 - bearing.D_b / bearing.D_m
errors = {}
for speed in (1500, 1, 0.1, 0.02):
    found = calculate_from_geometry(bearing, speed)
    right = speed / 60 * slip / 2
    errors[speed] = found.f_outer_ring / (bearing.N_b * right) - 1, found.f_cage / right - 1
    print(speed, 'rpm: outer ring', found.f_outer_ring, 'Hz, errors of outer ring and cage', errors[speed])
assert max(map(abs, errors[1500])) < 1e-5
assert abs(errors[0.1][0] - 0.021) < 0.001 and abs(errors[0.1][1] - 0.054) < 0.001
assert abs(errors[0.02][1] + 0.247) < 0.001
for speed in (0.005, 0, -60):
    try:
        calculate_from_geometry(bearing, speed)
    except ValueError as error:
        print(speed, 'rpm:', error)
    else:
        raise AssertionError
PYTHON

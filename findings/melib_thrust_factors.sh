#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# melib 1.1.1: for a ball bearing with a thrust factor Y of 1.6, the limit e is found as 0.44 instead of 0.27.
#
# dgbbrtfacs() interpolates in a table of thrust factors of deep groove ball bearings. In the iteration that its
# documentation describes, Y is given and e is sought. But Y falls in the table, while numpy.interp() needs rising
# values: between two entries of the table it always gives the last one, e of 0.44 and T/C0 of 0.56. A Y of 1.6 has e of
# 0.27 and T/C0 of 0.08, which the same function finds if T/C0 is given. Only at an entry, such as 1.55, is e right.
# For us: `gearkin loads --cam-rating` needs no such factors, as the force on the cam is radial.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check melib==1.1.1 numpy==2.4.6 scipy==1.17.1 matplotlib==3.11.2 \
    pylatex==1.4.2 openpyxl==3.1.5 pandas==3.1.1
cd "$folder"
timeout 120 "$folder/venv/bin/python" - <<'PYTHON'
from melib.library import dgbbrtfacs

for thrust_factor in (1.2, 1.5, 1.6, 2.2):
    e, relative_thrust, _ = dgbbrtfacs(Y=thrust_factor)
    print('Y', thrust_factor, 'e', e, 'T/C0', relative_thrust)
    assert (e, relative_thrust) == (0.44, 0.56)
assert dgbbrtfacs(Y=1.55)[0] == 0.28
e, _, thrust_factor = dgbbrtfacs(TC=0.0754)
print('T/C0 0.0754', 'e', e, 'Y', thrust_factor)
assert abs(thrust_factor - 1.6) < 0.01 and abs(e - 0.27) < 0.01
PYTHON

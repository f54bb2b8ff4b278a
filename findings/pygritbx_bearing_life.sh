#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pygritbx 1.1.4: an angular contact ball bearing that lives for 3796 million turns is given 30116 million.
#
# Under 1000 N radially and 500 N axially, updateReaction() finds 707 N radially: it takes the axial force, a scalar,
# from all three components, also from those that are 0. calculateBearingLife() has the exponent 10/3 of roller
# bearings, as the class compares the type "Contact Ball" with "ball". ISO 281 has 3 for ball bearings, so the life is
# (15600 N / 1000 N)³ = 3796 million turns. The equivalent static load, which is not less than the radial one, is 614 N.
# For us: `gearkin loads --cam-rating` has the exponent 3.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pygritbx==1.1.4 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from pygritbx.force import Force
from pygritbx.support import Support

bearing = Support(
    name='output', bearingType='Contact Ball', d=25, D=52, B=15, C=15600, C0=10200,
    e=1.14, X=0.57, Y2=0.93, Y0=0.52, axis=np.array([0, 0, 1]),
)  # 7205 B, at 40°
bearing.n = 1500
bearing.F_tot = Force(np.array([1000.0, 0.0, 500.0]), np.zeros(3))
bearing.updateReaction()
bearing.calculateEquivalentDynamicLoad()
bearing.calculateEquivalentStaticLoad()
bearing.calculateA1(90)
bearing.a_skf = 1
bearing.calculateBearingLife()
print('axial', bearing.F_a, 'radial', bearing.F_r, 'static', bearing.P0, 'life in millions of turns', bearing.L_10m)
assert bearing.F_a == 500
assert abs(bearing.F_r - 707.107) < 1e-3
assert abs(bearing.P0 - 613.55) < 1e-2
assert bearing.p == 10 / 3
assert abs(bearing.L_10m - 30116) < 1
assert bearing.L_10m > 7.9 * (15600 / 1000) ** 3
PYTHON

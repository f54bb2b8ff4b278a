#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# openTorsion 0.3.2: a shaft that is given by its stiffness and moment of inertia has six times this inertia.
#
# A shaft of steel, 500 mm long and 40 mm thick, is clamped at one end. Expected: by its length and diameter, or by its
# stiffness and its inertia, as documented in Nm/rad and kgm², it is the same shaft. What happens: the second one has
# six times the inertia, and its first natural frequency is 4472 rad/s in place of 10954; the exact one is 9935. In a
# geared drive the frequency of a long shaft comes out 2.4 times too low.
# For us: give I divided by 6 with k, or add the inertia to the disks at both ends, half at each.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check opentorsion==0.3.2
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from opentorsion import Assembly, Disk, Shaft

modulus, density, length, diameter = 80e9, 8000.0, 0.5, 0.04
area_moment = np.pi * diameter**4 / 32
stiffness, inertia = modulus * area_moment / length, density * area_moment * length
shafts = {
    'dimensions': Shaft(0, 1, L=500, odl=40),
    'stiffness and inertia': Shaft(0, 1, k=stiffness, I=inertia),
    'stiffness and a sixth of the inertia': Shaft(0, 1, k=stiffness, I=inertia / 6),
}
clamp = Disk(0, 1e9)
frequencies, inertias = {}, {}
for name, shaft in shafts.items():
    frequencies[name] = max(Assembly([shaft], [clamp]).modal_analysis()[0])
    inertias[name] = shaft.M().sum() / inertia
    print(name, round(frequencies[name], 1), 'rad/s, inertia times', round(inertias[name], 6))
exact = np.pi / 2 * np.sqrt(modulus / density) / length
print('exact', round(exact, 1), 'rad/s')
by_size, given, sixth = frequencies.values()
assert abs(by_size / exact - 1.1) < 0.01 and abs(sixth - by_size) < 1e-3
assert abs(given / by_size - 1 / np.sqrt(6)) < 1e-6
assert np.allclose(list(inertias.values()), [1, 6, 1])
PYTHON

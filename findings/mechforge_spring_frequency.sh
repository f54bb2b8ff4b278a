#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mechforge 0.1.0: a spring with a natural frequency of 351 Hz is given 2.8 Hz, and the load rating that a bearing needs
# at 99 % is too low.
#
# Of a helical spring between two plates, the lowest frequency is half the root of stiffness over the mass of its active
# coils: 350.8 Hz for a wire of 2 mm, a diameter of 16 mm, 8 coils and 80 GPa. What happens: natural_frequency is
# 2.77 Hz, 126 times too low: the 1000 from mm to m is put under a root, where also 32 stands instead of 2. The
# stiffness is right.
# For a bearing, C_required does not depend on the reliability, although the life does: at 99 % it is 44.8 kN, with
# which the bearing would live for 1680 of the 8000 hours that are desired; 75.4 kN are right. Above 99 % the life stays
# that of 99 %. Its documentation gives equations of the stiffness, the stress and the basic life only.
# For us: compute the frequency from spring_rate, and divide the life that is desired by the factor of the reliability.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    mechforge==0.1.0 numpy==2.4.6 scipy==1.17.1 pint==0.25.3
timeout 100 "$folder/venv/bin/python" -W ignore - <<'PYTHON'
import math

from mechforge.core.units import Q
from mechforge.machine.bearings import BearingSelection
from mechforge.machine.springs import HelicalSpring

wire, diameter, coils, density = 0.002, 0.016, 8, 7850
spring = HelicalSpring(Q(2, 'mm'), Q(16, 'mm'), Q(50, 'mm'), coils, Q(1700, 'MPa'), Q(80, 'GPa')).analyze(Q(50, 'N'))
stiffness = spring.spring_rate.to('N/m').magnitude
mass = density * math.pi * wire**2 / 4 * math.pi * diameter * coils
right = math.sqrt(stiffness / mass) / 2
found = spring.natural_frequency.to('Hz').magnitude
print(f'stiffness {stiffness:.1f} N/m, frequency {found:.3f} Hz, right is {right:.1f} Hz')
assert abs(stiffness - 80e9 * wire**4 / (8 * diameter**3 * coils)) < 1e-6 * stiffness
assert abs(found - 2.774) < 0.001 and abs(right - 350.8) < 0.1

HOURS, SPEED, LOAD = 8000, 1500, 5
given = {}
for reliability, factor in ((0.9, 1.0), (0.99, 0.21), (0.995, None)):
    bearing = BearingSelection(
        type='deep_groove',
        bore=Q(40, 'mm'),
        radial_load=Q(LOAD, 'kN'),
        speed=Q(SPEED, 'rpm'),
        desired_life_hours=HOURS,
        reliability=reliability,
    ).analyze()
    given[reliability] = bearing.C_required.to('kN').magnitude, bearing.L10_hours
    print(f'reliability {reliability}: {given[reliability][0]:.1f} kN needed, life {given[reliability][1]:.0f} h')
    if factor:
        rating = LOAD * (HOURS * 60 * SPEED / 1e6 / factor) ** (1 / 3)
        life = factor * (given[reliability][0] / LOAD) ** 3 * 1e6 / (60 * SPEED)
        print(f'    right is {rating:.1f} kN; with what it asks for it lives {life:.0f} h')
assert given[0.9][0] == given[0.99][0] == given[0.995][0]
assert abs(given[0.99][1] - 0.21 * given[0.9][1]) < 1e-6 * given[0.9][1] and given[0.995] == given[0.99]
PYTHON

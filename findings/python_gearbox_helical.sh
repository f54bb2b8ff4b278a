#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# python-gearbox 0.1.2.a.dev: two helical gears are 1.1 mm too far apart, and two shifted ones have too much contact.
#
# Two gears with 20 and 60 teeth, module 2 mm, helix angle 25° and no profile shift mesh at half of the sum of their
# reference diameters, 88.270 mm. Expected as `aw`: this. What happens: 89.386 mm, as the working pressure angle is
# transverse, but the one that it is divided by is the normal one, cos 20° / cos 21.88°. With straight teeth, where both
# angles are the same, it is right. With a profile shift of 0.5 on both straight gears, they are at 81.850 mm. Expected
# as the contact ratio there: 1.523; it gives 1.647, as it takes the distance of 80 mm of gears that are not shifted.
# For us: a·cos(alpha_t)/cos(alpha_wt), and this distance in the contact ratio as well.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps python-gearbox==0.1.2a0.dev0
cd "$folder"
venv/bin/python - <<'PYTHON'
from math import cos, pi, radians, sin, sqrt

from gearbox.transmition.gears import Gear, Lubricant, Material, Tool, Transmition

module, pressure = 2.0, 20.0
tool, steel = Tool(1.0, 1.25, 0.38, 0, 0, 0, 0), Material(1500.0, 460.0, 286.0, 'Eh')


def mesh(helix, shift):
    """The distance of the axes in mm and the contact ratio: as expected, and as found."""
    gears = [Gear(tool, steel, teeth, helix, 20.0, 20.0, pressure, module, shift) for teeth in (20, 60)]
    pair = Transmition(Lubricant(160.0), 1500.0, 500.0, 2, 10.0, 1000.0, gears, 1.0, 1.0, 1.0)
    radii = [module * teeth / cos(radians(helix)) / 2 for teeth in (20, 60)]
    transverse, working = radians(gears[0].alpha_t), radians(pair.alpha_wt)
    bases = [radius * cos(transverse) for radius in radii]
    distance = sum(bases) / cos(working)
    tips = [radius + module * (1 + shift) for radius in radii]
    path = sum(sqrt(tip ** 2 - base ** 2) for tip, base in zip(tips, bases)) - distance * sin(working)
    return (distance, path / (pi * module / cos(radians(helix)) * cos(transverse))), (pair.aw, pair.epsilon_alpha)


for helix, shift, expected_ratios, expected_extra in ((0.0, 0.0, 0.0, 0.0), (25.0, 0.0, 0.0, 1.1156),
                                                      (0.0, 0.5, 0.1239, 0.0)):
    expected, found = mesh(helix, shift)
    print(f'helix {helix}°, shift {shift}: {found[0]:.3f} mm instead of {expected[0]:.3f} mm, '
          f'contact ratio {found[1]:.3f} instead of {expected[1]:.3f}')
    assert abs(found[0] - expected[0] - expected_extra) < 1e-3
    assert abs(found[1] - expected[1] - expected_ratios) < 1e-3
assert abs(mesh(25.0, 0.0)[0][0] - 40 * module / cos(radians(25.0))) < 1e-9
PYTHON

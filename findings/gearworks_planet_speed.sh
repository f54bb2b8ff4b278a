#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# py_gearworks 0.0.24: the planets of a planetary gear turn in the wrong direction.
#
# A sun of 20 teeth, planets of 20 and a ring of 60; the sun turns at 1, the carrier is fixed. Expected of get_ratio():
# planets at -1, as two equal gears in mesh. What happens: they are at 1/3, the mean of the sun's and the ring's speed,
# whatever their teeth; with a fixed ring at 1/2 instead of -1/2. The sun, the ring and the carrier are right in all
# cases.
# For us: compute a planet, and the speed of its bearing, from carrier - (sun - carrier) * n_sun / n_planet.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps \
    py_gearworks==0.0.24 numpy==2.4.6
cd "$folder"/venv/lib/python3*/site-packages/py_gearworks  # this module needs no others of the package, which draw
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from fractions import Fraction

from planetary_gearset import PlanetaryGearset, PlanetaryGearType

SUN, PLANET, RING = 20, 20, 60
gear = PlanetaryGearset(SUN, RING, PLANET, 3)
cases = {
    ('SUN', 'CARRY'): (-1, Fraction(1, 3)),
    ('SUN', 'RING'): (Fraction(-1, 2), Fraction(1, 2)),
    ('CARRY', 'SUN'): (2, Fraction(2, 3)),
}
for (driven, fixed), (right, expected) in cases.items():
    speeds = gear.get_ratio(1, PlanetaryGearType[driven], PlanetaryGearType[fixed])
    at_sun = speeds.carry - (speeds.sun - speeds.carry) * SUN / PLANET
    at_ring = speeds.carry + (speeds.ring - speeds.carry) * RING / PLANET
    print(driven, 'drives,', fixed, 'is fixed:', speeds, 'planet by its meshes', at_sun, at_ring)
    assert abs(at_sun - right) < 1e-9 and abs(at_ring - right) < 1e-9
    assert abs(speeds.planet - expected) < 1e-9
PYTHON

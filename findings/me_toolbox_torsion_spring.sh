#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# me-toolbox 0.0.18: a torsion spring of 10 g weighs 1.5 kg, and one that is wound up by 0.15 turns is narrowed as by
# 0.95 turns.
#
# A spring that takes the play out of a gear: steel wire of 2 mm, 20 mm wide, six active coils, legs of 30 mm, which its
# greatest moment turns by 1 rad. Expected of weight with 7850 kg/m³: the wire of the coils and of both legs, 10.3 g.
# What happens: 1.49 kg, as the legs' length in mm is taken as one in m. Expected of loaded_diameter, the "diameter
# after load is applied": as the wire keeps its length, its coils get narrower as they get more, and N coils of 20 mm
# that are wound up by 0.151 turns have 20 mm · N/(N + 0.151) = 19.5 mm. What happens: 17.1 mm, as the angle in radians
# is taken for turns; a pin of 16 mm, which has 1.5 mm of play in the spring, is said to have -0.9 mm.
# For us: weigh with legs of 0, add them yourself, and divide the angle by 2 pi. The package needs icecream, which it
# does not name.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check me-toolbox==0.0.18 icecream==2.1.5 numpy==2.4.6 sympy==1.14.0
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
from math import pi

from me_toolbox.springs import HelicalTorsionSpring

WIRE, WIDTH, LEG, STEEL = 2.0, 20.0, 30.0, 2e5
rate = HelicalTorsionSpring.calc_spring_rate(WIRE, WIDTH, 6.0, STEEL)
spring = HelicalTorsionSpring(
    max_moment=rate * 1.0, wire_diameter=WIRE, spring_diameter=WIDTH, leg1=LEG, leg2=LEG,
    ultimate_tensile_strength=1700, yield_percent=0.78, shear_modulus=8e4, elastic_modulus=STEEL,
    spring_rate=rate, arbor_diameter=16.0, density=7850,
)
coils = spring.body_coils
length = (pi * WIDTH * coils + 2 * LEG) / 1000
mass = pi * (WIRE / 2000) ** 2 * length * 7850
print('weight', spring.weight, 'kg instead of', mass, 'kg')
assert abs(mass - 0.0103) < 1e-4 and abs(spring.weight - 1.488) < 0.01

turns = spring.calc_angular_deflection(spring.max_moment, False) / (2 * pi)
narrowed = WIDTH * coils / (coils + turns)
print('width wound up by', turns, 'turns', spring.loaded_diameter, 'mm instead of', narrowed, 'mm')
print('play of a pin of 16 mm', spring.clearance, 'mm instead of', narrowed - WIRE - 16, 'mm')
assert abs(spring.max_angular_deflection - 1) < 1e-9 and abs(turns - 0.151) < 0.001
assert abs(narrowed - 19.48) < 0.01 and abs(spring.loaded_diameter - 17.14) < 0.01
assert spring.clearance < -0.8 and narrowed - WIRE - 16 > 1.4
PYTHON

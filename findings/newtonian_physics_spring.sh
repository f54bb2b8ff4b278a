#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# newtonian-physics 0.2.0: a stretched spring pushes its ends apart, and with a damper they part by 2.5 km within 0.5 s.
#
# A mass of 1 kg hangs on a fixed body by a spring with a rest length of 1 m and a stiffness of 100 N/m, is stretched by
# 0.1 m and let go without gravity. Expected by Hooke's law: an acceleration of -100 N/m · 0.1 m / 1 kg = -10 m/s²
# towards the fixed body, and a swing of ±0.1 m at 1.6 Hz. What happens: +10 m/s² away from it, and e^(10 t) growth,
# as of a stiffness of -100 N/m. With a damping of 20 N·s/m, which would bring it to rest without any swing, it leaves
# faster still: both forces of Spring have the wrong sign.
# For us: apply the force of a spring to the bodies yourself; to exchange them does not help.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check newtonian-physics==0.2.0
cd "$folder"
venv/bin/python - <<'PYTHON'
import math

from pyphysics import Body, Circle, Spring, Vec2, World


def moved(damping, seconds, swapped=False):
    """The place of the mass from its rest in m after this time in s, where it begins at 0.1 m."""
    world = World(gravity=Vec2(0.0, 0.0))
    base = Body.static(shape=Circle(0.01), position=Vec2(0.0, 0.0))
    mass = Body.dynamic(shape=Circle(0.01), position=Vec2(1.1, 0.0), mass=1.0, damping=0.0)
    world.add(base)
    world.add(mass)
    ends = (mass, base) if swapped else (base, mass)
    world.add_spring(Spring(*ends, rest_length=1.0, stiffness=100.0, damping=damping))
    for _ in range(round(seconds * 10000)):
        world.step(0.0001)
    return mass.position.x - 1.0


first = (moved(0.0, 0.0001) - 0.1) / 0.0001 ** 2
print('acceleration of the first step', first, 'm/s², expected -10 m/s²')
assert abs(first - 10.0) < 0.1
free, damped = moved(0.0, 0.5), moved(20.0, 0.5)
print('after 0.5 s:', free, 'm, expected', 0.1 * math.cos(5), 'm; damped', damped, 'm, expected 0.004 m')
assert abs(free - 0.1 * math.cosh(5)) < 0.05 and 2000 < damped < 3000
assert abs(moved(0.0, 0.5, swapped=True) - free) < 1e-6
PYTHON

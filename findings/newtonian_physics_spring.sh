#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# newtonian-physics 0.2.0: a stretched spring pushes its load away, to 14 km within 3 s, and a force has no effect.
#
# Its README names "Gravity, force accumulation, persistent acceleration, and damping" among its features, and World has
# add_spring(). A load of 1 kg stands 0.5 m beyond the rest of a spring of 10 N/m. Expected: it swings back, to 0.5 m
# after 1 s, and comes to rest with a damper. What happens: it is at 7 m after 1 s, and with a damper of 1 N·s/m at 14
# km after 3 s, as spring and damper act on both ends with the wrong sign. A force of 1 N that apply_force() gives
# before each step should give 1 m/s after 1 s; it gives 0 m/s, in World and in World3D, as step() clears all forces
# first. There is no warning.
# For us: give springs and dampers negative values, and forces as accelerations; or use another engine.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check newtonian-physics==0.2.0
timeout 60 "$folder/venv/bin/python" -W error - <<'PYTHON'
import math

from pyphysics import Body, Body3D, Circle, Sphere, Spring, Vec2, Vec3, World, World3D


def position(damper, steps):
    world = World(gravity=Vec2(0, 0))
    wall = world.add(Body.static(shape=Circle(0.1), position=Vec2(0, 0)))
    load = world.add(Body.dynamic(shape=Circle(0.1), position=Vec2(1.5, 0), mass=1.0, damping=0.0))
    world.add_spring(Spring(wall, load, rest_length=1.0, stiffness=10.0, damping=damper))
    for _ in range(steps):
        world.step(0.01)
    return load.position.x


def speed(world, load, force):
    world.add(load)
    for _ in range(100):
        load.apply_force(force)
        world.step(0.01)
    return load.velocity.x


swinging, damped = position(0.0, 100), position(1.0, 300)
print('load after 1 s', swinging, 'm, right', 1 + 0.5 * math.cos(math.sqrt(10)), 'm; with a damper after 3 s', damped, 'm')
assert abs(swinging - (1 + 0.5 * math.cosh(math.sqrt(10)))) < 0.2 and 13000 < damped < 15000
flat = speed(World(gravity=Vec2(0, 0)), Body.dynamic(shape=Circle(0.1), mass=1.0, damping=0.0), Vec2(1, 0))
solid = speed(World3D(gravity=Vec3(0, 0, 0)), Body3D.dynamic(shape=Sphere(0.1), mass=1.0, damping=0.0), Vec3(1, 0, 0))
print('speed under 1 N after 1 s: World', flat, 'World3D', solid, 'm/s, right 1 m/s')
assert flat == 0 and solid == 0
PYTHON

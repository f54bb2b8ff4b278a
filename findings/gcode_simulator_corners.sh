#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# gcode-simulator 0.2.1: a circle of 180 lines takes 9.5 s, not 6.3 s, and an axis reverses at 2.8 mm/s.
#
# It promises an "accurate time estimation with junction deviation modeling" for a machine with Grbl and its settings.
# Grbl passes a corner with a speed v of v² = a·δ·s/(1 - s), where δ is the junction deviation ($11) and s the cosine of
# half the change of direction. So it does not slow down where the direction hardly changes, and stands where it
# reverses. What happens: δ/sin of half the change is taken as the radius. A circle of 50 mm radius of 180 lines at 50
# mm/s is slowed down to 21 mm/s at each corner. Where an axis reverses, it goes on at 2.8 mm/s in the other direction
# at once. Arcs by G2 and G3 and lines with X and Y alone take no time and have no bounds, without a warning.
# For us: for a gantry's times, take Grbl's formula, as the lines below do.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check gcode-simulator==0.2.1
cd "$folder"
MPLBACKEND=agg timeout 60 venv/bin/python - <<'PYTHON'
import math

from gcode_simulator import GCodeSimulator, GrblSettings
from gcode_simulator.gcode_simulator import Point

ACCELERATION, DEVIATION, SPEED, RADIUS, LINES = 800.0, 0.01, 50.0, 50.0, 180
SETTINGS = GrblSettings(
    max_rate_x=6000, max_rate_y=6000, max_accel_x=ACCELERATION, max_accel_y=ACCELERATION, junction_deviation=DEVIATION
)


def found(text):
    return GCodeSimulator(SETTINGS).estimate_time(text)


def grbl(change):
    """The speed of Grbl in mm/s at a corner with a change of direction in rad."""
    s = math.cos(change / 2)
    return math.sqrt(ACCELERATION * DEVIATION * s / (1 - s))


def simulated(change):
    after = Point(math.cos(change), math.sin(change))
    return GCodeSimulator(SETTINGS).calculate_junction_vmax(Point(1, 0), after) / 60


for change, library in ((2 * math.pi / LINES, 21.41), (math.pi / 2, 3.36), (math.pi, 2.83)):
    print(f'corner of {math.degrees(change):.0f}°: Grbl {grbl(change):.2f} mm/s, found {simulated(change):.2f} mm/s')
    assert abs(simulated(change) - library) < 0.01
assert grbl(2 * math.pi / LINES) > SPEED and grbl(math.pi) < 1e-6

angles = [2 * math.pi * line / LINES for line in range(1, LINES + 1)]
circle = '\n'.join(f'G1 X{RADIUS * math.sin(a):.4f} Y{RADIUS - RADIUS * math.cos(a):.4f} F3000' for a in angles)
length = LINES * 2 * RADIUS * math.sin(math.pi / LINES)
right = length / SPEED + SPEED / ACCELERATION  # no corner slows it down: one ramp up, one ramp down
print(f'circle: {right:.2f} s, found {found(circle)[0]:.2f} s')
assert abs(right - 6.35) < 0.01 and abs(found(circle)[0] - 9.51) < 0.01

straight = found('G1 X10 F600')[0]
print('10 mm at 10 mm/s and 800 mm/s²:', straight, 's')
assert abs(straight - 1.0125) < 1e-6
for text in ('G1 X10 F600\nX20', 'G1 X10 F600\nG2 X30 I10 J0'):
    time, bounds = found(text)
    print(repr(text), time, 's, up to X', bounds.max_x)
    assert time == straight and bounds.max_x == 10
PYTHON

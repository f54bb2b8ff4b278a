#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# gcode-lib 1.1.13: an arc with R is turned about its start, and lines with G01 or without blanks are left out.
#
# A quarter circle of 10 mm about the origin can be written with I and J or with R, and by RS-274/NGC (NISTIR 6556,
# 3.3) blanks do not matter and leading zeros may be written; Marlin reads all of it. What happens: R is parsed, but
# not used, so that linearize_arcs() takes the start as the center: the path from (10, 0) to (0, 10) jumps to (24.1,
# 0.2) first and is drawn with a radius of 14 mm; compute_bounds() says so, too. translate_xy() and rotate_xy() leave
# "G01 X30 Y5" and "G1X40 Y5" where they are and move the lines around them, and estimate_print() gives a move by G01
# no time. Its limitations name none of it, and nothing warns.
# For us: write G-code with blanks, without leading zeros and with I and J before this library reads it.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check gcode-lib==1.1.13
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import math

import gcode_lib


def path(arc):
    """Points of the arc from (10, 0) to (0, 10) as lines."""
    lines = gcode_lib.linearize_arcs(gcode_lib.parse_lines(f'G90\nG0 X10 Y0\n{arc}'))
    assert all(line.command != 'G3' for line in lines)
    return [(line.words['X'], line.words['Y']) for line in lines if line.is_move]


radii = [math.hypot(*point) for point in path('G3 X0 Y10 I-10 J0')]
assert all(abs(radius - 10) < 1e-6 for radius in radii)
by_radius = path('G3 X0 Y10 R10')
farthest = max(math.hypot(*point) for point in by_radius)
print(f'arc with R10: from {by_radius[0]} to ({by_radius[1][0]:.2f}, {by_radius[1][1]:.2f}), up to {farthest:.1f} mm')
assert gcode_lib.parse_line('G3 X0 Y10 R10').words['R'] == 10
assert abs(by_radius[1][0] - 24.14) < 0.01 and abs(by_radius[1][1] - 0.2) < 0.01
bounds = gcode_lib.compute_bounds(gcode_lib.parse_lines('G90\nG0 X10 Y0\nG3 X0 Y10 R10'))
assert abs(bounds.x_max - 24.14) < 0.01

program = gcode_lib.parse_lines('G90\nG0 X10 Y0\nG1 X20 Y5\nG01 X30 Y5\nG1X40 Y5')
moved = [line.raw for line in gcode_lib.translate_xy(program, dx=100, dy=0)]
print('moved by 100 mm:', moved)
assert moved == ['G90', 'G0 X110 Y0', 'G1 X120 Y5', 'G01 X30 Y5', 'G1X40 Y5']
turned = [line.raw for line in gcode_lib.rotate_xy(program, 90, pivot_x=0, pivot_y=0)]
assert turned == ['G90', 'G0 X0 Y10', 'G1 X-5 Y20', 'G01 X30 Y5', 'G1X40 Y5']

seconds = {}
for code in ('G1', 'G01'):
    lines = gcode_lib.parse_lines(f'G90\nG0 X10 Y0 F600\n{code} X300 Y0')
    before = gcode_lib.estimate_print(lines[:2]).time_seconds
    seconds[code] = gcode_lib.estimate_print(lines).time_seconds - before
print(f'times of 290 mm at 10 mm/s: {seconds} in s')
assert abs(seconds['G1'] - 29) < 0.01 and seconds['G01'] == 0
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# gcode-simulator 0.2.1: an axis that may go 5 mm/s makes its 100 mm within 2.9 s where another axis moves too.
#
# GrblSettings gives each axis its own greatest rate and acceleration, $110, $111, $120 and $121 of a Grbl. Expected of
# a diagonal move: the slowest axis limits it, as in a Grbl, so that 100 mm at 5 mm/s take 20 s, as they do where this
# axis moves alone. What happens: the length of the vector of both limits is taken as the limit along the move, which is
# above that of either axis. The same holds for the acceleration: with 8 instead of 800 mm/s² for one axis the move
# takes 2.09 s, at least 7.07 s are needed. A line that goes on with the G1 of the line before, or has no space behind
# its G1, is not counted at all.
# For us: divide the path of each axis by its own limit; the greatest time is the least that the move can take.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check gcode-simulator==0.2.1 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import math

from gcode_simulator import GCodeSimulator, GrblSettings

FAST, SLOW, PATH = 3000.0, 300.0, 100.0


def seconds(gcode, rate_y=FAST, acceleration_y=800.0):
    settings = GrblSettings(max_rate_x=FAST, max_rate_y=rate_y, max_accel_x=800.0, max_accel_y=acceleration_y)
    return GCodeSimulator(settings).estimate_time(gcode)[0]


alone, diagonal = seconds('G1 Y100 F9000', rate_y=SLOW), seconds('G1 X100 Y100 F9000', rate_y=SLOW)
print(f'at most {SLOW / 60} mm/s: alone {alone:.2f} s, with a faster axis {diagonal:.2f} s')
assert alone > PATH / (SLOW / 60) and abs(diagonal - 2.86) < 0.01
least, gentle = 2 * math.sqrt(PATH / 8.0), seconds('G1 X100 Y100 F9000', acceleration_y=8.0)
print(f'at most 8 mm/s²: at least {least:.2f} s are needed, {gentle:.2f} s are found')
assert least > 7.07 and abs(gentle - 2.09) < 0.01
there, back, modal, joined = (seconds(gcode) for gcode in ('G1 X100', 'G1 X100\nG1 X0', 'G1 X100\nX0', 'G1X100'))
print(f'there {there:.2f} s, there and back {back:.2f} s, as "X0" {modal:.2f} s, "G1X100" {joined:.2f} s')
assert back > 1.9 * there and modal == there and joined == 0
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# gcodeparser 0.3.0: of a path whose lines share one G1, the first move alone is read, and the comment "(before M3)"
# is M3.
#
# A reference path of an axis has G1 in its first line and the axis alone in the next, as CAM programs write it, since
# G1 stays in force. Expected of parse_gcode_lines(): four moves, to X40. What happens: a line without G, M or T is
# left out without a warning, so that the path ends at X10. A probing move, G38.2, loses what is behind the point and
# the axes with it, and G92.1, which ends an offset, is read as G92, which sets one. Words in round brackets, which
# are comments, are read as commands: "(before M3)" is M3. A blank between G and its number leaves the line out too.
# For us: put G1 into each line and remove comments in brackets before the program is parsed.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check gcodeparser==0.3.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from gcodeparser import parse_gcode_lines


def read(program):
    return [(line.command_str, line.params) for line in parse_gcode_lines(program)]


modal = read('G90\nG1 X10 F100\nX20\nX30\nX40\n')
probe = read('G38.2 X-10 F50\nG92.1\n')
comment = read('G1 X5 (before M3)\n')
blank = read('G 1 X5\n')
for name, lines in (('modal', modal), ('probe', probe), ('comment', comment), ('blank', blank)):
    print(name, lines)
assert modal == [('G90', {}), ('G1', {'X': 10, 'F': 100})]
assert probe == [('G38', {}), ('G92', {})]
assert comment == [('G1', {'X': 5}), ('M3', {})] and blank == []
PYTHON

#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# gcode-machine 1.0.3: G91.1 is taken for G91, so that a tool that goes to X30 stays at X0.5.
#
# G91.1 only says that I and J count from the start of an arc, as Grbl takes them anyway; the coordinates stay absolute.
# What happens where it has a line of its own, as split_lines() makes it of "G90 G91.1": it sets current_distance_mode
# to G91. G0 X10, G1 X20, G1 X30 then end at 60, and fractionize() writes the pieces of G1 X30 as steps of 0.5 mm, which
# a machine in G90 takes for the position 0.5. In G91 itself, the pieces are rounded to 0.001 mm each: 100 mm along x
# and y become 100.11 mm, and position_m says 100. Nothing warns of it.
# For us: take out G91.1, and break up lines only in G90.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check gcode-machine==1.0.3
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import logging
import re

from gcode_machine import GcodeMachine

logging.disable(logging.CRITICAL)


def process(*program):
    """The machine after the program, and the lines of fractionize(), by the loop of the README."""
    machine = GcodeMachine((0, 0, 0), 'G54', {'G54': (0, 0, 0)})
    machine.do_fractionize_lines = True
    lines = []
    for line in program:
        machine.set_line(line)
        machine.strip()
        machine.tidy()
        machine.parse_state()
        lines += machine.fractionize()
        machine.done()
    return machine, [line for line in lines if not line.startswith(';')]


moves = ['G0 X10', 'G1 X20 F600', 'G1 X30']
machine, lines = process('G90', *moves)
assert machine.position_m[0] == 30 and lines[-1] == 'X30'
machine, lines = process('G90', 'G91.1', *moves)
print(f'behind G90 and G91.1: position {machine.position_m[0]}, {lines[:3]}, last lines {lines[-2:]}')
assert machine.position_m[0] == 60
assert 'G91.1' in lines and 'G91' not in lines and lines[-1].startswith('X0.5')
machine.set_line('G90 G91.1')
assert [part.strip() for part in machine.split_lines()] == ['G90', 'G91.1']

machine, lines = process('G91', 'G1 X100 Y100 F600')
sent = sum(float(match[1]) for match in (re.search(r'X([-.\d]+)', line) for line in lines) if match)
print(f'100 mm in G91: the pieces make {sent:.3f} mm, the machine says {machine.position_m[0]}')
assert abs(sent - 100.11) < 0.001 and machine.position_m[0] == 100
PYTHON

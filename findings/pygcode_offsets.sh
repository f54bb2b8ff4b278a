#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pygcode 0.2.1: an axis at 10 mm that G92 X0 calls 0 has moved to 0, and a move of 1 inch is one of 1 mm.
#
# Expected of Machine, which follows a program: after G0 X10 and G92 X0 the axis has not moved, so that it is at 10 mm
# of the machine and at 0 of the work, and G1 X5 takes it to 15 mm. What happens: the words of G92 are taken as those
# of the last kind of move, so that G92 X0 takes the axis to 0, and G92.1 brings nothing back. abs_pos and the range
# that the axes need, abs_range_max, follow this. G10 L2 P1 X5, which shifts the zero of G54, does nothing, and G28
# does not go home. After G20, which is for inches, X1 is 1 mm: abs_pos.unit stays that of millimetres. No error, no
# warning.
# For us: follow programs without G20, G28, G92 and G10 only.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pygcode==0.2.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from pygcode import Machine
from pygcode.machine import UNIT_METRIC


def places(*program):
    """The place of the axis X in the machine and in the work after the program, and the greatest one on the way."""
    machine = Machine()
    for line in program:
        machine.process_str(line)
    assert machine.abs_pos.unit == machine.abs_range_max.unit == UNIT_METRIC
    found = machine.abs_pos.X, machine.pos.X, machine.abs_range_max.X
    print(' / '.join(program), found)
    return found


assert places('G0 X10') == (10, 10, 10)
assert places('G0 X10', 'G92 X0') == (0, 0, 10)
assert places('G0 X10', 'G92 X0', 'G1 X5 F100') == (5, 5, 10)
assert places('G0 X10', 'G92 X0', 'G92.1') == (0, 0, 10)
assert places('G10 L2 P1 X5', 'G0 X10') == (10, 10, 10)
assert places('G0 X10', 'G28') == (10, 10, 10)
assert places('G20', 'G0 X1') == (1, 1, 1)
assert places('G91', 'G0 X1', 'X1') == (2, 2, 2)
PYTHON

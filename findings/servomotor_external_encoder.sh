#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# servomotor 0.12.2: a whole turn of an external encoder of 4096 counts is read as 0.45°, and multimove() always fails.
#
# An M17 servomotor with an external encoder of 4096 counts a turn, in degrees. Expected of
# get_comprehensive_position(): the motor's two positions in degrees, and the count of the encoder, which the library's
# own table of commands says must not be converted. What happens: the same table asks for the conversion, and 4096
# counts are divided by the 9102.2 counts per degree of the motor: a turn is 0.45°, or 0.00125 shaft_rotations.
# multimove() asks for a unit that no motor has, and raises an AttributeError before anything is sent; it is the only
# command that queues moves of two kinds at once.
# For us: set position_unit='encoder_counts' for this reading, and divide by the counts of the encoder.
#
# The motor's answer is given in place of its port. Exit code 0: still so. Installs the package into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check servomotor==0.12.2
cd "$folder"
timeout 60 venv/bin/python - > log 2>&1 <<'PYTHON' || { cat log; exit 1; }
import struct

import servomotor
from servomotor import communication

MOTOR_TURN, ENCODER_TURN = 3276800, 4096
sent = []


def answer(alias, command, payload, **options):
    sent.append(command)
    return [struct.pack('<qqi', MOTOR_TURN, MOTOR_TURN, ENCODER_TURN)]


communication.send_command = answer
for unit, motor_turn, encoder_turn in (('degrees', 360.0, 0.45), ('shaft_rotations', 1.0, 0.00125), ('encoder_counts', 3276800.0, 4096.0)):
    motor = servomotor.M3(1, position_unit=unit, verbose=0)
    found = motor.get_comprehensive_position()
    print('read in', unit, found)
    assert all(abs(value - right) < 1e-9 * abs(right) for value, right in zip(found, (motor_turn, motor_turn, encoder_turn), strict=True))
sent.clear()
try:
    motor.multimove(2, 0b10, [[100, 1000], [0, 1000]])
except AttributeError as error:
    print('multimove:', error)
else:
    raise SystemExit(1)
assert not sent
PYTHON
grep -E '^(read|multimove)' log

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mksact 0.2.0: a closed-loop stepper that is to turn to 600 turns is sent to -424 turns.
#
# Expected: 600 turns, or an error. What happens: the target is cut to the 24 bits of the command, of 16384 counts a
# turn, so it wraps beyond ±512 turns without an error; before a gear of 19 that is less than 27 turns of its output.
# The position is read in 48 bits, so that move_rel() gets there by single turns: the move from 511 turns to 513 is one
# back by 1022.
# For us: set min_pos and max_pos within ±512 turns.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mksact==0.2.0 python-can==4.6.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import can
from mksact.actuator import Actuator

COUNTS = 16384
actuator = Actuator(channel='bus', interface='virtual', verbose=False)
with can.Bus('bus', interface='virtual') as actuator.bus, can.Bus('bus', interface='virtual') as drive:
    actuator.homed = actuator._alive = True
    for turns, expected in ((511, 511), (513, -511), (600, -424), (-600, 424)):
        actuator.move_abs(turns * COUNTS)
        target = int.from_bytes(drive.recv(1).data[4:7], 'big', signed=True) / COUNTS
        print('turn to', turns, 'is sent as', target)
        assert target == expected
PYTHON

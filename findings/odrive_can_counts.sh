#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# odrive-can 2.1.0: in its database for firmware 0.5.6 the encoder's counts have no sign.
#
# Shadow_Count of Get_Encoder_Count is the number of counts since the start, int32 in the firmware. In the .dbc of
# the package it is unsigned: decoded by cantools, as the package does, -1 is 4294967295. In the same file the
# velocity of Set_Input_Vel is in "rev" and its torque in "rev/s"; that for firmware 0.6.10 has rev/s and Nm.
# Pos_Estimate, in turns, is right.
# For us: take the rotor's position from Pos_Estimate.
#
# Exit code 0: still so. Installs the packages into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check odrive-can==2.1.0 cantools==45.1.0
"$folder/venv/bin/python" - <<'PYTHON'
import struct

import cantools
from odrive_can import get_dbc

database = get_dbc('odrive-cansimple-0.5.6')
count = database.get_message_by_name('Axis0_Get_Encoder_Count').decode(struct.pack('<ii', -1, 100))
estimate = database.get_message_by_name('Axis0_Get_Encoder_Estimates').decode(struct.pack('<ff', -0.5, 0.0))
units = [signal.unit for signal in database.get_message_by_name('Axis0_Set_Input_Vel').signals]
print(count, estimate, units)
assert count['Shadow_Count'] == 4294967295
assert estimate['Pos_Estimate'] == -0.5
assert units == ['rev', 'rev/s']
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# cybergeardriver 0.2.0, robstride 0.1.0: a motor that is too hot has no fault, and one that runs is shown in reset.
#
# A CyberGear or RobStride motor reports its mode and its faults in the identifier of each feedback: a bit for each
# fault, and two bits for the mode, 0 for reset, 1 for calibration, 2 for run. Here the motor runs, is too hot and is
# not calibrated. Expected: these. What happens: cybergeardriver takes bytes for bits, so that it never sees a fault,
# and its mode is always 0. robstride cuts one bit off from the faults and one from the mode: the motor is hot and in
# reset, and never uncalibrated, although the package has a name for that. Positions, velocities and torques are right
# in both.
# For us: python-cybergear 0.1.2 reads all three; otherwise take the bits 16 to 23 of the identifier.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check cybergeardriver==0.2.0 robstride==0.1.0 python-can==4.6.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct

import can
import robstride
from CyberGearDriver import CyberGearMotor, CyberMotorMessage

MOTOR, HOST, FEEDBACK = 0x7F, 0xAA, 2
RUN, HOT, UNCALIBRATED = 2 << 22, 1 << 18, 1 << 21
IDENTIFIER = FEEDBACK << 24 | RUN | HOT | UNCALIBRATED | MOTOR << 8 | HOST
DATA = struct.pack('>4H', 39321, 32767, 32767, 905)

motor = CyberGearMotor(MOTOR, send_message=None, host_id=HOST)
motor.message_received(CyberMotorMessage(IDENTIFIER, bytearray(DATA)))
print('cybergeardriver', motor.state, motor.faults)
assert round(motor.state['position'], 6) == 2.5
assert not any(motor.faults.values())
assert motor.state['mode_status'] == 0

with can.Bus('bus', interface='virtual') as host, can.Bus('bus', interface='virtual') as drive:
    drive.send(can.Message(arbitration_id=IDENTIFIER, data=DATA, is_extended_id=True))
    read = robstride.Client(host, host_can_id=HOST).enable(MOTOR)
print('robstride', read)
assert [error.name for error in read.errors] == ['Overtemp']
assert read.mode.name == 'Reset'
PYTHON

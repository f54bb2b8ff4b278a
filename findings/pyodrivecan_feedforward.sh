#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pyodrivecan 0.1.3: a feedforward of 2 turns/s is sent as 0.002 turns/s, and a motor keeps an error that is cleared.
#
# The documentation of set_position() gives "Feedforward velocity" and "Feedforward torque" without a unit, where all
# other methods take revolutions, revolutions per second and N·m. Expected: 2 turns/s and 3 N·m arrive. What happens:
# they are packed as they are into two fields of 16 bits, whose unit in ODrive's CAN protocol is 0.001 turns/s and
# 0.001 N·m; a feedforward of 0.5 is a struct.error. active_error, documented as the current error, is only ever set:
# it remains when the ODrive reports in its next message that it has no error. So does disarm_reason, which is
# documented as the last one. A virtual CAN bus takes the place of the drive.
# For us: give both feedforwards as whole thousandths, and set active_error to None before each message.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pyodrivecan==0.1.3 python-can==4.6.1
cd "$folder"
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct

import can
from pyodrivecan import ODriveCAN

ODriveCAN.can_setup_done = True
drive = can.Bus('drive', interface='virtual')
motor = ODriveCAN(1, canBusID='drive', canBusType='virtual', database='motor.db')

motor.set_position(1.0, velocity_feedforward=2, torque_feedforward=3)
sent = drive.recv(1)
position, speed, torque = struct.unpack('<fhh', sent.data)
print('Sent:', position, 'turns,', speed * 0.001, 'turns/s,', torque * 0.001, 'N·m')
assert sent.arbitration_id == 1 << 5 | 0x0C and (position, speed, torque) == (1.0, 2, 3)
try:
    motor.set_position(1.0, velocity_feedforward=0.5)
except struct.error as error:
    print('0.5 turns/s:', error)
else:
    raise AssertionError('0.5 turns/s were sent')


def report(active, reason):
    drive.send(can.Message(arbitration_id=1 << 5 | 0x03, data=struct.pack('<II', active, reason), is_extended_id=False))
    motor.process_can_message(motor.canBus.recv(1))
    return motor.active_error, motor.disarm_reason


hot = report(0x4000, 0x4000)
cleared = report(0, 0)
print('Errors while it is hot:', hot, 'and after they are cleared:', cleared)
assert hot == cleared == ('INVERTER_OVER_TEMP', 'INVERTER_OVER_TEMP')
drive.shutdown()
motor.bus_shutdown()
PYTHON

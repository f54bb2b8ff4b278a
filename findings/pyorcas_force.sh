#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pyOrcas 0.1.7: the force of an Orca motor is always 0, and a position of -1 µm is read as 4294.967295 m.
#
# Expected: the registers of the Orca's Modbus guide hold signed words of 32 bits, the force of a motor that pushes with
# 12 N is 12000 mN, and one that has moved back by 1 µm is at -1 µm. What happens: `force` reads the register, keeps the
# value as the position and returns what it had before, 0. Position, speed and acceleration are read without a sign,
# while the answers to commands are read with it. `kinematic.home` is the motion that runs, 3, not the home, 7. A stub
# takes the place of the serial line and answers from a table of registers.
# For us: publish no effort from `force`; subtract 2**32 from 2**31 on.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pyOrcas==0.1.7 pymodbus==3.16.1 pyserial==3.5
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct

import pyOrcas.actuator as orca

registers = {orca.MODE_OF_OPERATION: 1, orca.KINEMATIC_STATUS: 3, orca.KIN_HOME_ID: 7}
for address, value in ((orca.SHAFT_POSITION_UM, -1), (orca.SHAFT_SPEED_MMPS, -5), (orca.FORCE, 12000)):
    registers[address], registers[address + 1] = struct.unpack('<2H', struct.pack('<i', value))


class Line:
    def __init__(self, **settings):
        self.request = b''

    def connect(self):
        return True

    def close(self):
        pass

    def send(self, request):
        self.request = request

    def recv(self, size):
        function, address, count = struct.unpack('>BHH', self.request[1:6])
        if function != orca.Read:
            return self.request[:8]
        words = [registers.get(address + k, 0) for k in range(count)]
        return bytes([1, 3, 2 * count]) + struct.pack(f'>{count}H', *words) + b'\0\0'


orca.ModbusSerialClient = Line
motor = orca.Actuator(port='line', baudrate=19200)
print('position', motor.position, 'µm; speed', motor.velocity, 'mm/s; force', motor.force, 'mN; home', motor.kinematic.home)
assert (motor.position, motor.velocity) == (4294967295, 4294967291)
assert (motor.force, motor._position) == (0, 12000)
assert motor.kinematic.home == 3
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pyOrcas 0.1.7: the force of an Orca motor is never read and stays at 0, and a position of -1 µm is 4294.967295 m.
#
# Expected: the registers of the Orca's Modbus guide hold signed words of 32 bits, the force of a motor that pushes with
# 12 N is 12000 mN, and one that has moved back by 1 µm is at -1 µm. What happens: `force` reads the register, keeps the
# value as the position and returns what it had before: 0, or the force in the answer to the last command. Position,
# speed and acceleration are read without a sign, while the answers to commands are read with it. `kinematic.home` is
# the motion that runs, 3, not the home, 7. A local socket in place of the serial line answers here from a table of
# registers. The package needs a pymodbus below 3.7, although it does not say so.
# For us: publish no effort from `force`; subtract 2**32 from 2**31 on.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pyOrcas==0.1.7 pymodbus==3.6.9 pyserial==3.5
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import socket
import struct
import threading

import pyOrcas.actuator as orca

registers = {orca.MODE_OF_OPERATION: 1, orca.KINEMATIC_STATUS: 3, orca.KIN_HOME_ID: 7}
for address, value in ((orca.SHAFT_POSITION_UM, -1), (orca.SHAFT_SPEED_MMPS, -5), (orca.FORCE, 12000)):
    registers[address], registers[address + 1] = struct.unpack('<2H', struct.pack('<i', value))
server = socket.create_server(('127.0.0.1', 0))


def crc(data):
    value = 0xFFFF
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = value >> 1 ^ (0xA001 if value & 1 else 0)
    return struct.pack('<H', value)


def answer():
    line = server.accept()[0]
    while request := line.recv(8, socket.MSG_WAITALL):
        assert request[:2] == b'\x01\x03' and crc(request[:6]) == request[6:]
        address, count = struct.unpack('>HH', request[2:6])
        words = struct.pack(f'>{count}H', *(registers.get(address + k, 0) for k in range(count)))
        reply = bytes([1, 3, len(words)]) + words
        line.sendall(reply + crc(reply))


threading.Thread(target=answer, daemon=True).start()
motor = orca.Actuator(port=f'socket://127.0.0.1:{server.getsockname()[1]}', baudrate=19200)
print('position', motor.position, 'µm; speed', motor.velocity, 'mm/s; force', motor.force, 'mN; home', motor.kinematic.home)
assert (motor.position, motor.velocity) == (4294967295, 4294967291)
assert (motor.force, motor._position) == (0, 12000)
assert motor.kinematic.home == 3
PYTHON

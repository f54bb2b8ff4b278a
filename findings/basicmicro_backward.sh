#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# basicmicro 2.0.10: a motor at -500 counts/s is read at 4294966796 counts/s, and its position error not at all.
#
# Expected: the motor that was sent SpeedM1(-500), which the README calls "500 counts per second backward", is read at
# -500 counts/s. What happens: GetISpeeds() and GetSpeeds(), whose answers have no status byte with the direction, take
# the 32 bits as an unsigned number, although the library has a reader of signed ones. GetPosErrors() and
# GetSpeedErrors() read two words of 16 bits where the RoboClaw's manual (commands 111 and 114) gives two of 32 bits,
# so that each call ends in a PacketTimeoutError. A port answers here as that manual says.
# For us: subtract 2^32 from speeds of 2^31 and more, and take the error as the goal less the count.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check basicmicro==2.0.10 pyserial==3.5
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct
from unittest import mock

from basicmicro import Basicmicro
from basicmicro.exceptions import PacketTimeoutError


def checksum(data):
    """CRC-16 with the polynomial 0x1021, as the manual gives it."""
    crc = 0
    for byte in data:
        crc ^= byte << 8
        for _ in range(8):
            crc = crc << 1 ^ 0x1021 if crc & 0x8000 else crc << 1
            crc &= 0xFFFF
    return crc


class Port:
    """A RoboClaw whose first motor turns at the speed that it was sent, 70 000 counts behind its goal."""

    is_open = True
    speed = 0

    def __init__(self, **settings):
        self.request, self.answer = b'', b''

    def reset_input_buffer(self):
        self.answer = b''

    reset_output_buffer = flushInput = close = reset_input_buffer

    def write(self, data):
        self.request += data
        address, command = self.request[:2] if len(self.request) >= 2 else (0, 0)
        if command == 35 and len(self.request) == 8:
            self.speed = struct.unpack('>i', self.request[2:6])[0]
            self.answer = b'\xff'
        elif command in (79, 108, 111, 114):
            values = {79: (self.speed, 0), 108: (self.speed, 0), 111: (-5, 0), 114: (70_000, 0)}[command]
            self.answer = struct.pack('>2i', *values)
            self.answer += struct.pack('>H', checksum(self.request + self.answer))
        else:
            return
        self.request = b''

    def read(self, count):
        data, self.answer = self.answer[:count], self.answer[count:]
        return data


with mock.patch('serial.Serial', Port):
    claw = Basicmicro('port', 115200)
    assert claw.Open()
    read = {}
    for speed in (500, -500):
        assert claw.SpeedM1(0x80, speed)
        read[speed] = claw.GetISpeeds(0x80)[:2], claw.GetSpeeds(0x80)[:2]
    errors = []
    for reader in (claw.GetSpeedErrors, claw.GetPosErrors):
        try:
            errors.append(reader(0x80))
        except PacketTimeoutError as error:
            errors.append(None)
            print(error)
print('Speeds:', read, 'errors:', errors)
assert read[500] == ((True, 500), (True, 500))
assert read[-500] == ((True, 4294966796), (True, 4294966796))
assert errors == [None, None]
PYTHON

#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pycomm3 1.2.16: the enable of a drive in B3/17 of an SLC or MicroLogix PLC is written to B3/16, its brake.
#
# The bits of a file B3 are numbered through: B3/17 is the same bit as B3:1/1. Expected of SLCDriver, which takes both
# forms: the same bit. What happens: the number is divided by 16 as a real number, so that the rest is always 0, and
# each bit n is read from and written to bit 0 of its word. Where the brake is B3/16 and the enable B3/17, setting the
# enable sets the brake, and both seem to be the same. No error is returned, and a bit that was written is read back.
# A server that takes the typed reads and masked writes of PCCC apart takes the place of the PLC.
# Output: B3:1 after B3/17 = 1: 0x1, after B3:1/1 = 1: 0x3; with 0x2 in B3:1: B3/17 False, B3:1/1 True, B3/16 False
#         bits of B3 that are read and written right as B3/n: [0, 16, 32, 48]
# For us: name bits as B3:1/1, by word and bit.
#
# Exit code 0: still so. Installs the version into a temporary folder; the server is on the loopback address.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pycomm3==1.2.16
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import socket
import struct
import threading

from pycomm3 import SLCDriver

UNREGISTER, UNCONNECTED, CONNECTED = 0x66, 0x6F, 0x70
OPEN, CLOSE, PCCC = 0x54, 0x4E, 0x4B
READ, WRITE, FILE_B = 0xA2, 0xAB, 0x85
NOT_SUPPORTED = 8


class Controller:
    """The words of the file B3, which are read and written by the typed commands with three address fields."""

    def __init__(self, size):
        self.words = [0] * size
        self.server = socket.create_server(('127.0.0.1', 0))
        threading.Thread(target=self.serve, daemon=True).start()

    def serve(self):
        while True:
            line, _ = self.server.accept()
            stream = line.makefile('rb')
            while header := stream.read(24):
                command, length = struct.unpack_from('<HH', header)
                body = stream.read(length)
                if command == UNREGISTER:
                    break
                if command == UNCONNECTED:
                    service = body[16]
                    status = 0 if service in (OPEN, CLOSE) else NOT_SUPPORTED
                    found = bytes([service | 0x80, 0, status, 0]) + struct.pack('<II', 1, 2) + bytes(18)
                    body = body[:6] + struct.pack('<HIHH', 2, 0, 0xB2, len(found)) + found
                elif command == CONNECTED:
                    found = body[20:22] + self.request(body[22:])
                    body = body[:6] + struct.pack('<HHHIHH', 2, 0xA1, 4, 2, 0xB1, len(found)) + found
                line.sendall(struct.pack('<HHI', command, len(body), 7) + bytes(4) + header[12:] + body)

    def request(self, request):
        assert request[0] == PCCC
        requester, (command, _, number, function) = request[6:13], struct.unpack_from('<BBHB', request, 13)
        size, file, kind, word, part = request[18:23]
        assert command == 0x0F and (size, file, kind, part) == (2, 3, FILE_B, 0)
        found = b''
        if function == READ:
            found = struct.pack('<H', self.words[word])
        else:
            assert function == WRITE
            mask, value = struct.unpack('<HH', request[23:])
            self.words[word] = self.words[word] & ~mask | value & mask
        return bytes([PCCC | 0x80, 0, 0, 0]) + requester + struct.pack('<BBH', 0x4F, 0, number) + found


plc = Controller(4)
with SLCDriver(f'127.0.0.1:{plc.server.getsockname()[1]}') as client:
    def read(name):
        found = client.read(name)
        assert found.error is None
        return found.value

    seen = []
    for name in ('B3/17', 'B3:1/1'):
        assert client.write((name, 1)).error is None and read(name)
        seen.append(plc.words[1])
    plc.words[1] = 0x2
    states = [read(name) for name in ('B3/17', 'B3:1/1', 'B3/16')]
    right = []
    for bit in range(64):
        plc.words[:] = [0] * 4
        client.write((f'B3/{bit}', 1))
        written = plc.words == [1 << bit % 16 if word == bit // 16 else 0 for word in range(4)]
        plc.words[bit // 16] = 1 << bit % 16
        if written and read(f'B3/{bit}'):
            right.append(bit)

print(f'B3:1 after B3/17 = 1: 0x{seen[0]:X}, after B3:1/1 = 1: 0x{seen[1]:X};',
      'with 0x2 in B3:1: B3/17 {}, B3:1/1 {}, B3/16 {}'.format(*states))
print('bits of B3 that are read and written right as B3/n:', right)
assert seen == [1, 3] and states == [False, True, False]
assert right == [0, 16, 32, 48]
PYTHON

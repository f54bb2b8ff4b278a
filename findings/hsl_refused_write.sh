#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# HslCommunication 1.2.0: a goal that an Omron PLC refuses counts as written, and over Modbus RTU a disturbed position
# counts as read.
#
# By FINS, an answer has an end code after its command, 2101 hex where an area is read-only; 0 means done. Expected of
# OmronFinsNet.WriteInt32() that is answered with 2101: IsSuccess is False, as it is for a read that is refused. What
# happens: IsSuccess is True and ErrorCode is 0, so that nothing tells the refusal, and the PLC keeps the old goal.
# A frame of Modbus RTU ends with a CRC. Expected of ModbusRtuOverTcp, where a bit of the answer has changed on its way:
# an error. What happens: the CRC is cut off and not looked at, and a position of 1000 is read as -31768 with IsSuccess.
# Two devices are simulated: a PLC over FINS/TCP, whose words can be written or not, and a drive over RTU.
# For us: read a goal back after each write, and use another library for RTU.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check HslCommunication==1.2.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import socketserver
import struct
import threading

from HslCommunication import ModbusRtuOverTcp, OmronFinsNet

READ, READ_ONLY = 0x0101, 0x2101
words = {100: 7, 101: 0}


class Plc(socketserver.BaseRequestHandler):
    """FINS over TCP: the first frame exchanges the nodes, the others have a header of FINS and a command."""

    protected = False

    def frames(self):
        while head := self.request.recv(8, socketserver.socket.MSG_WAITALL):
            yield self.request.recv(struct.unpack('>4sI', head)[1], socketserver.socket.MSG_WAITALL)

    def answer(self, command, content):
        body = struct.pack('>II', command, 0) + content
        self.request.sendall(b'FINS' + struct.pack('>I', len(body)) + body)

    def handle(self):
        for frame in self.frames():
            if struct.unpack('>I', frame[:4])[0] == 0:
                self.answer(1, struct.pack('>II', 10, 20))
                continue
            command, _, address, _, count = struct.unpack('>HBHBH', frame[18:26])
            code, data = 0, b''
            if command == READ:
                data = b''.join(struct.pack('>H', words[address + place]) for place in range(count))
            elif self.protected:
                code = READ_ONLY
            else:
                words.update(enumerate(struct.unpack(f'>{count}H', frame[26:]), address))
            self.answer(2, frame[8:18] + struct.pack('>HH', command, code) + data)


def crc(data):
    value = 0xFFFF
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = value >> 1 ^ (0xA001 if value & 1 else 0)
    return struct.pack('<H', value)


class Drive(socketserver.BaseRequestHandler):
    """Modbus RTU over TCP: a register with 1000, and a line that turns the highest bit of it over."""

    disturbed = False

    def handle(self):
        while self.request.recv(256):
            answer = struct.pack('>BBBh', 1, 3, 2, 1000)
            answer = bytearray(answer + crc(answer))
            answer[3] ^= 0x80 * self.disturbed
            self.request.sendall(answer)


def served(handler):
    server = socketserver.ThreadingTCPServer(('127.0.0.1', 0), handler)
    server.daemon_threads = True
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server.server_address


plc = OmronFinsNet(*served(Plc))
assert plc.ConnectServer().IsSuccess
written = plc.WriteInt32('D100', 1000)
assert written.IsSuccess and plc.ReadInt32('D100').Content == 1000
Plc.protected = True
refused, goal = plc.WriteInt32('D100', 2000), plc.ReadInt32('D100').Content
print(f'refused: IsSuccess {refused.IsSuccess}, ErrorCode {refused.ErrorCode}, and the goal is {goal}')
assert refused.IsSuccess and refused.ErrorCode == 0 and goal == 1000

drive = ModbusRtuOverTcp(*served(Drive))
assert drive.ConnectServer().IsSuccess
sound = drive.ReadInt16('0')
Drive.disturbed = True
disturbed = drive.ReadInt16('0')
print(f'sound: {sound.Content}; disturbed: IsSuccess {disturbed.IsSuccess}, {disturbed.Content}')
assert sound.Content == 1000 and disturbed.IsSuccess and disturbed.Content == -31768
PYTHON

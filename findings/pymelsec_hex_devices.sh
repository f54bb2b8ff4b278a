#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pymelsec 0.2.5: 100000 counts in W9 are read as -293216, a write there changes W10, and the switch XA is called X10.
#
# X, Y, B and W of a Q or iQ-R PLC are numbered in hexadecimal, which pymelsec knows where it reads one word: W1F is the
# 32nd. Expected of a value of 32 bits in W9: the words W9 and WA. What happens: the next number is counted in decimal,
# so that the words are W9 and W10, which is the seventh after it. The upper half of a position is that of another one,
# and where a position is written, the other one is changed, all without an error. The same happens in W19, W29 and so
# on; D is right. batch_read reads the right inputs, but counts their names in decimal: from X0 on, the eleventh, XA, is
# called X10. Besides, read() rounds a FLOAT to six decimals: a speed of 0.0000004 turns a second becomes 0. A server on
# this machine answers here as a PLC does by the reference manual of the MELSEC communication protocol.
# For us: keep positions in D, and take inputs of batch_read by their place in the list.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pymelsec==0.2.5
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import socket
import struct
import threading

from pymelsec import Type3E
from pymelsec.constants import DT
from pymelsec.tag import Tag

CODES = {0x9C: 'X', 0xB4: 'W', 0xA8: 'D'}
memory = {('X', number): int(number == 0xA) for number in range(32)}
for name, number, value in (('W', 0x9, 100000), ('W', 0x10, -5), ('D', 9, 100000), ('D', 16, -5)):
    memory[name, number], memory[name, number + 1] = struct.unpack('<HH', struct.pack('<i', value))
memory['D', 200], memory['D', 201] = struct.unpack('<HH', struct.pack('<f', 4e-7))
server = socket.create_server(('127.0.0.1', 0))


def device(data):
    """Return the name and the number of a device."""
    return CODES[data[3]], int.from_bytes(data[:3], 'little')


def answer():
    """Answer reads and writes of chosen words and reads of bits."""
    connection, _ = server.accept()
    while request := connection.recv(256):
        command, body = int.from_bytes(request[11:13], 'little'), request[15:]
        if command == 0x0403:
            data = b''.join(struct.pack('<H', memory[device(body[2 + 4 * k :])]) for k in range(body[0]))
        elif command == 0x1402:
            for k in range(body[0]):
                item = body[2 + 6 * k :]
                memory[device(item)] = int.from_bytes(item[4:6], 'little')
            data = b''
        else:
            name, first = device(body)
            bits = [memory[name, first + k] for k in range(int.from_bytes(body[4:6], 'little'))]
            data = bytes(16 * high + low for high, low in zip(bits[::2], bits[1::2]))
        connection.sendall(b'\xd0\0\0\xff\xff\x03\0' + struct.pack('<HH', 2 + len(data), 0) + data)


def held(name, number):
    """Return the value of 32 bits that the PLC has."""
    return struct.unpack('<i', struct.pack('<HH', memory[name, number], memory[name, number + 1]))[0]


threading.Thread(target=answer, daemon=True).start()
with Type3E(host='127.0.0.1', port=server.getsockname()[1], plc_type='Q') as plc:
    places = ('W9', DT.SDWORD), ('W10', DT.SDWORD), ('D9', DT.SDWORD), ('D200', DT.FLOAT)
    read = {tag.device: tag.value for tag in plc.read([Tag(device=name, type=kind) for name, kind in places])}
    print('read:', read, '; the PLC has', held('W', 9), 'in W9 and 4e-7 in D200')
    inputs = [tag.device for tag in plc.batch_read('X0', 32, DT.BIT) if tag.value]
    print('inputs that are said to be on:', inputs, '; the PLC has XA')
    plc.write([Tag(device='W9', value=200000, type=DT.SDWORD)])
    print('200000 written to W9: the PLC has', held('W', 0x9), 'in W9 and', held('W', 0x10), 'in W10, which was -5')
assert read == {'W9': -293216, 'W10': -5, 'D9': 100000, 'D200': 0.0}, read
assert inputs == ['X10']
assert (held('W', 0x9), held('W', 0x10)) == (68928, -65533)
PYTHON

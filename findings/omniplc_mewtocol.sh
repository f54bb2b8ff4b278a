#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# omniplc 0.56.5: over MEWTOCOL, a position of 1000 in D100 of a Panasonic PLC is read as -6141, and sent as -6141.
#
# By MEWTOCOL-COM, the commands RD and WD carry each word as four hexadecimal digits, the low byte first: 1000, which is
# 03E8, goes as E803 (Panasonic's manuals draw it as "Low High"). Expected of PanasonicMewtocolTcpClient: 1000. What
# happens: it takes the high byte first, so that each word has its bytes exchanged, without an error: -5 is -1025, 70000
# counts in two words are 16805905, and 1.5 rad are -2.98. Goals are sent in the same way, so that the same client reads
# them back right, and a round trip does not show it. A PLC is simulated that keeps its words as numbers.
# For us: exchange the bytes of each word, or let the PLC speak Modbus.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check omniplc==0.56.5
cat > "$folder/plc.py" <<'PYTHON'
import functools
import operator
import re
import socketserver
import struct
import threading

from omniplc import PanasonicMewtocolTcpClient

REQUEST = re.compile(r'%01#(RD|WD)D(\d{5})(\d{5})(\w*)..')
words = {}


class Plc(socketserver.StreamRequestHandler):
    def handle(self):
        while line := b''.join(iter(functools.partial(self.rfile.read, 1), b'\r')).decode():
            command, first, last, data = REQUEST.fullmatch(line).groups()
            places = range(int(first), int(last) + 1)
            if command == 'WD':
                words.update(zip(places, struct.unpack(f'<{len(places)}H', bytes.fromhex(data)), strict=True))
                data = ''
            else:
                data = b''.join(struct.pack('<H', words[place]) for place in places).hex().upper()
            answer = f'%01${command}{data}'
            self.wfile.write(f'{answer}{functools.reduce(operator.xor, answer.encode()):02X}\r'.encode())


server = socketserver.ThreadingTCPServer(('127.0.0.1', 0), Plc)
server.daemon_threads = True
threading.Thread(target=server.serve_forever, daemon=True).start()
client = PanasonicMewtocolTcpClient(*server.server_address, station=1)
assert client.connect()


def kept(code, value):
    """Keep a number in the words from 100 on, the lower word first."""
    data = struct.pack('<' + code, value)
    words.update(enumerate(struct.unpack(f'<{len(data) // 2}H', data), 100))


for code, read, value, wrong in (
    ('h', client.read_short, 1000, -6141),
    ('h', client.read_short, -5, -1025),
    ('i', client.read_int, 70000, 16805905),
    ('f', client.read_float, 1.5, -2.984),
):
    kept(code, value)
    done, found = read('D100')
    print(f'{value} in the PLC is read as {found}')
    assert done and abs(found - wrong) <= 1e-2 * abs(wrong)

assert client.write_short('D100', 1000)
(sent,) = struct.unpack('<h', struct.pack('<H', words[100]))
print(f'1000 is sent as {sent}, and read back as {client.read_short("D100")[1]}')
assert sent == -6141 and client.read_short('D100') == (True, 1000)
client.disconnect()
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/plc.py"

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# melsec-mc-protocol 1.1.0: -5 is read as 65531, SD8 from D8, SM400 from F400, a counter from the contacts of timers.
#
# Its documentation names the devices of a PLC that it reads and writes, and says that a register is signed with 16
# bits. By the reference manual of the MELSEC communication protocol, each kind has a code: SM has 91, SD A9, the
# current values of timers C2 and those of counters C5. What happens: a word is read without its sign. SD has the code
# of D, SM that of F, so that SM400, which is always on, is off; S has that of SM and V that of SD. TC, the current
# value of a timer by the documentation, has the code of the coils of timers, and CC and C have that of their contacts,
# so that 16 bits of other devices are read as a count of turns. X, Y, M, D, W, R, L, B and F are right. Nothing is
# reported. A server on this machine answers here as a PLC does by the manual.
# For us: copy counters, times and flags to D in the program of the PLC, and take the sign from bit 15.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check melsec-mc-protocol==1.1.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import contextlib
import io
import socket
import struct
import threading

from melsec_mc import DeviceType, MelsecMCProtocol

# What the PLC holds, by the codes of the manual. Contacts and coils are read here as words of 16 bits.
NAMES = {0x91: 'SM', 0xA9: 'SD', 0xA8: 'D', 0x93: 'F', 0xC0: 'coils of timers', 0xC1: 'contacts of timers'}
NAMES |= {0xC2: 'current values of timers', 0xC5: 'current values of counters'}
memory = {('SM', 400): 1, ('SD', 8): 1250, ('D', 8): 77, ('D', 100): 0x10000 - 5, ('F', 400): 0}
memory |= {('coils of timers', 3): 0b1010, ('contacts of timers', 3): 0b10, ('current values of timers', 3): 480}
memory |= {('current values of counters', 3): 1520}
asked = []
server = socket.create_server(('127.0.0.1', 0))


def answer():
    """Answer reads of one device."""
    connection, _ = server.accept()
    while request := connection.recv(64):
        device = NAMES[request[18]], int.from_bytes(request[15:18], 'little')
        asked.append(device)
        in_bits = int.from_bytes(request[13:15], 'little') == 1
        data = bytes([16 * memory[device]]) if in_bits else struct.pack('<H', memory[device])
        connection.sendall(bytes.fromhex('D00000FFFF0300') + struct.pack('<HH', 2 + len(data), 0) + data)


threading.Thread(target=answer, daemon=True).start()
plc = MelsecMCProtocol('127.0.0.1', server.getsockname()[1])
assert plc.connect()
found = {}
for kind, number in (('D', 100), ('SD', 8), ('SM', 400), ('C', 3), ('CC', 3), ('TC', 3), ('T', 3)):
    with contextlib.redirect_stdout(io.StringIO()):
        value = plc.read_single_register(DeviceType[kind], number)
    found[f'{kind}{number}'] = value, asked[-1][0]
    print(f'{kind}{number} is', value, 'read from', *asked[-1])
plc.disconnect()
assert found == {
    'D100': (65531, 'D'),
    'SD8': (77, 'D'),
    'SM400': (0, 'F'),
    'C3': (2, 'contacts of timers'),
    'CC3': (2, 'contacts of timers'),
    'TC3': (10, 'coils of timers'),
    'T3': (10, 'coils of timers'),
}, found
PYTHON

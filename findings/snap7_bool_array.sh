#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# python-snap7 3.3.0: writing eight flags as an array of BOOL to an S7 PLC clears the speed and position behind them.
#
# Expected: DB1.DBX0.0:BOOL[8] is the eight bits of one byte, as an S7 PLC stores an array of BOOL, or it is an error.
# What happens: each element is taken as a byte of its own. read_tag() gives the bit 0 of eight bytes one after the
# other, of which seven belong to other variables, and write_tag() overwrites all eight bytes: here a speed of 100.0
# becomes 2.4e-38 and a position of -1 becomes 0 by a write of flags. The single bits, DB1.DBX0.3:BOOL, are right. The
# server of the package answers here.
# For us: read the byte, as DB1.DBB0:BYTE, and take its bits, or read and write bit by bit.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check python-snap7==3.3.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import ctypes
import socket

import snap7
from snap7.server import Server
from snap7.type import SrvArea

with socket.create_server(('127.0.0.1', 0)) as free:
    port = free.getsockname()[1]
memory = (ctypes.c_uint8 * 32)()
server = Server()
server.register_area(SrvArea.DB, 1, memory)
server.start(tcp_port=port)
client = snap7.Client()
client.connect('127.0.0.1', 0, 1, port)
client.write_tag('DB1.DBB0:BYTE', 0b00001101)
client.write_tag('DB1.DBD2:REAL', 100.0)
client.write_tag('DB1.DBW6:INT', -1)
single = [client.read_tag(f'DB1.DBX0.{bit}:BOOL') for bit in range(8)]
array = client.read_tag('DB1.DBX0.0:BOOL[8]')
client.write_tag('DB1.DBX0.0:BOOL[8]', single)
after = client.read_tag('DB1.DBB0:BYTE'), client.read_tag('DB1.DBD2:REAL'), client.read_tag('DB1.DBW6:INT')
client.disconnect()
server.stop()
print('bit by bit', single, 'as an array', array)
print('flags, speed and position after the flags were written:', after)
assert single == [True, False, True, True, False, False, False, False]
assert array == [True, False, False, False, False, False, True, True]
assert after[0] == 0b00001101 and after[2] == 0 and 0.0 < after[1] < 1e-37
PYTHON

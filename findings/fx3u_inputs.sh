#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# fx3u-mcprotocol 1.0.0: the input X10 of an FX3 PLC is read from X12, and a position of -1 in D100 is 65535.
#
# Inputs and outputs of an FX3 are counted in octal: X7 is followed by X10, which is the input 8. The manual of the
# FX3U-ENET-ADP says so for the frames as well (Y20 is 10 in hexadecimal). The library takes the number as decimal, so
# that X10 asks for the input 10, X12. From X10 on, each limit switch is another one, without an error; even X8 and
# X9, which do not exist, are read. Words are read without their sign. A server on this machine answers here as the
# PLC does.
# For us: give f'X{int("10", 8)}' for X10, and subtract 65536 from 32768 on.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check fx3u-mcprotocol==1.0.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import socket
import threading

from fx3u_mcprotocol import FX3UClient

pressed = {0o10}
position = -1
server = socket.create_server(('127.0.0.1', 0))


def answer():
    connection, _ = server.accept()
    with connection:
        while request := connection.recv(64).decode():
            device, first = bytes.fromhex(request[8:12]).decode().strip(), int(request[12:20], 16)
            if device == 'X':
                connection.sendall(b'80001' + b'0' if first in pressed else b'800000')
            else:
                connection.sendall(b'8100' + position.to_bytes(2, 'big', signed=True).hex().upper().encode())


threading.Thread(target=answer, daemon=True).start()
plc = FX3UClient('127.0.0.1', server.getsockname()[1])
plc.connect()
inputs = {name: plc.readBit(name) for name in ('X10', 'X12', 'X8')}
word = plc.readReg('D100')
plc.close()
print('X10 is pressed:', inputs, 'position -1:', word)
assert inputs == {'X10': False, 'X12': False, 'X8': True} and word == 65535
PYTHON

#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# fx3u-mcprotocol 1.0.0 (Python): the limit switch X10 of an FX3U is read from X12, and X20 from X24.
#
# The inputs and outputs of FX3 PLCs have octal names: X7 is followed by X10. In frames they are counted through, so
# that X10 is the device 8: the manual of the FX3U-ENET-ADP says of an output, "Y20" = 10 (hexadecimal), in chapter 7.5.
# The package is for these PLCs alone and takes their names; expected of readBit('X10'): the input X10.
# What happens: the name is taken as decimal, so that the device 10 is read, which is X12, and X20 is read from X24. X0
# to X7, M and D are right. X8 and X9, which no such PLC has, are read from X10 and X11. Nothing is reported. A server
# on this machine answers here as the adapter does by the manual.
# For us: name X and Y by their decimal numbers (X10 as X8).
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check fx3u-mcprotocol==1.0.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import socket
import threading

from fx3u_mcprotocol import FX3UClient

# One input alone is on at a time, by its number in frames; the flag M12 is on.
on = {'X': set(), 'M': {12}}
REGISTERS = {100: 5, 101: 1000}


def answer(frame):
    """Answer a frame in ASCII: read bits (00) or words (01), of the devices from the number on."""
    kind, name = frame[0:2], bytes.fromhex(frame[8:12]).decode().strip()
    first, count = int(frame[12:20], 16), int(frame[20:22], 16)
    numbers = range(first, first + count)
    if kind == '00':
        bits = ''.join('1' if number in on[name] else '0' for number in numbers)
        return '8000' + bits + '0' * (count % 2)
    return '8100' + ''.join(f'{REGISTERS[number]:04X}' for number in numbers)


def serve():
    connection, _ = listener.accept()
    with connection:
        while frame := connection.recv(100).decode():
            connection.sendall(answer(frame).encode())


listener = socket.create_server(('127.0.0.1', 0))
threading.Thread(target=serve, daemon=True).start()
plc = FX3UClient('127.0.0.1', port=listener.getsockname()[1], read_only=True)
plc.connect()
read = {}
for name in ('X0', 'X7', 'X8', 'X10', 'X20'):
    for number in range(64):
        on['X'] = {number}
        if plc.readBit(name):
            read[name] = f'X{number:o}'
words = plc.readRegs('D100', 2)
flag = plc.readBit('M12')
plc.close()
print('Inputs and where they are read:', read)
print('Registers of 5 and 1000:', words, 'M12, which is on:', flag)
assert read == {'X0': 'X0', 'X7': 'X7', 'X8': 'X10', 'X10': 'X12', 'X20': 'X24'}
assert words == [5, 1000] and flag
PYTHON

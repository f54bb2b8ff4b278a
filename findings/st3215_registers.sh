#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# st3215 0.4.2: a current of 1950 mA is read as 286 mA, and a position of -100 as 32868.
#
# The servo STS3215 has its present current in two bytes, at 69 and 70, in steps of 6.5 mA. ReadCurrent reads the first
# byte alone, so that the current falls to 0 every 1.66 A. Numbers have their sign in bit 15: ReadSpeed observes it,
# ReadPosition does not, so that a servo that counts several turns jumps by 32768 at 0. python-st3215 1.3.0
# reads both right. A pseudo-terminal answers here as a servo does.
# For us: a torque from this current is wrong where the load is greatest; a position above 32767 is a negative one.
#
# Exit code 0: still so. Installs the packages into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check st3215==0.4.2 python-st3215==1.3.0
cat > "$folder/read.py" <<'PYTHON'
import os
import pty
import threading
import tty

import python_st3215
from st3215 import ST3215


def servo(registers):
    def answer(terminal):
        while True:
            request = os.read(terminal, 256)
            number, address, length = request[2], request[5], request[6]
            content = bytes(registers[address + offset] for offset in range(length))
            status = bytes([number, length + 2, 0]) + content
            os.write(terminal, b'\xff\xff' + status + bytes([~sum(status) & 0xFF]))

    device, host = pty.openpty()
    tty.setraw(device)
    tty.setraw(host)
    threading.Thread(target=answer, args=(device,), daemon=True).start()
    return os.ttyname(host)


registers = bytearray(256)
registers[56:58] = (0x8000 | 100).to_bytes(2, 'little')
registers[58:60] = (0x8000 | 50).to_bytes(2, 'little')
registers[69:71] = (300).to_bytes(2, 'little')
bus = ST3215(servo(registers))
read = bus.ReadPosition(1), bus.ReadSpeed(1)[0], bus.ReadCurrent(1)
print('st3215 position', read[0], 'speed', read[1], 'current', read[2], 'mA')
assert read == (32868, -50, 286.0)
other = python_st3215.ST3215(servo(registers)).wrap_servo(1, False).sram
read = other.read_current_location(), other.read_current_speed(), other.read_current_current() * 6.5
print('python-st3215 position', read[0], 'speed', read[1], 'current', read[2], 'mA')
assert read == (-100, -50, 1950.0)
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/read.py"

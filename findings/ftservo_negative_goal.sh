#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# ftservo-python-sdk 2.0.1: a goal of -100 is sent as -32668, although a position of -100 is read right.
#
# A Feetech STS servo that counts several turns keeps the sign of a position in bit 15 and its amount in the others.
# ReadPos observes it. WritePosEx, SyncWritePosEx and RegWritePosEx send the low 16 bits of a negative number, 0xFF9C,
# which the servo and the kit's own ReadPos understand as -32668: eight turns the wrong way, at the commanded speed.
# WriteSpec converts its negative speeds. A pseudo-terminal answers here as a servo does that has reached its goal.
# For us: give the goal as `bus.scs_toscs(position, 15)`, or keep all goals positive by the servo's offset.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check ftservo-python-sdk==2.0.1 pyserial==3.5
cat > "$folder/move.py" <<'PYTHON'
import os
import pty
import threading
import tty

from scservo_sdk import PortHandler, sms_sts

WRITE, GOAL, POSITION = 3, 42, 56
registers = bytearray(256)
device, host = pty.openpty()
tty.setraw(device)
tty.setraw(host)


def answer():
    while True:
        request = os.read(device, 256)
        number, instruction, address, values = request[2], request[4], request[5], request[6:-1]
        content = b''
        if instruction == WRITE:
            registers[address : address + len(values)] = values
            registers[POSITION : POSITION + 2] = registers[GOAL : GOAL + 2]
        else:
            content = bytes(registers[address : address + values[0]])
        status = bytes([number, len(content) + 2, 0]) + content
        os.write(device, b'\xff\xff' + status + bytes([~sum(status) & 0xFF]))


threading.Thread(target=answer, daemon=True).start()
port = PortHandler(os.ttyname(host))
assert port.openPort()
bus = sms_sts(port)


def reached(goal):
    bus.WritePosEx(1, goal, 100, 0)
    return bus.ReadPos(1)[0]


found = {'100': reached(100), '-100': reached(-100), 'scs_toscs(-100, 15)': reached(bus.scs_toscs(-100, 15))}
print(found)
assert list(found.values()) == [100, -32668, -100]
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/move.py"

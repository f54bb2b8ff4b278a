#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# python-can-damiao 0.1.0: of answers that arrive together only the first is received, and with a wrong identifier.
#
# Expected: recv() gives one frame after the other, as with each other interface of python-can. What happens: it takes
# all whole frames out of what has arrived, returns the first of them, and forgets the others. So the answers of six
# motors to commands that are sent in a row are one answer, or some of them, depending on how the operating system
# hands them over. The adapter sends the lowest byte of an identifier first, and the driver takes it as the highest, so
# that 0x11 is 0x11000000. A pseudo-terminal answers here as the adapter does, in the frames of 16 bytes that the
# DM_CAN.py of DM_Control_Python reads.
# For us: use an adapter of SocketCAN; otherwise read one motor at a time, and tell the motors by their data.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    python-can-damiao==0.1.0 python-can==4.6.1 pyserial==3.5
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import os
import pty
import tty

import can

device, host = pty.openpty()
tty.setraw(device)
tty.setraw(host)
MOTORS = range(0x11, 0x17)  # the identifiers to which they answer; their own are 1 to 6


def answer(motor):
    return b'\xaa\x11\x08' + motor.to_bytes(4, 'little') + bytes([motor & 15, 128, 0, 128, 8, 0, 30, 28]) + b'\x55'


def received(bus):
    found = []
    while (message := bus.recv(timeout=0.5)) is not None:
        found.append((hex(message.arbitration_id), message.data[0]))
    return found


with can.Bus(interface='damiao', channel=os.ttyname(host), bitrate=1000000) as bus:
    os.write(device, b''.join(answer(motor) for motor in MOTORS))
    together = received(bus)
    one_by_one = []
    for motor in MOTORS:
        os.write(device, answer(motor))
        one_by_one += received(bus)
print('together', together, 'one by one', one_by_one)
assert together == [('0x11000000', 1)]
assert one_by_one == [(f'0x{motor:x}000000', motor & 15) for motor in MOTORS]
PYTHON

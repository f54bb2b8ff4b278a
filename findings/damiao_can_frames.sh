#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# python-can-damiao 0.1.0: of the answers of motors that arrive together, only the first is ever received.
#
# Expected: recv() gives one frame after the other, as with each other interface of python-can. What happens: it takes
# all whole frames out of what has arrived, returns the first of them, and forgets the others. So the answers of six
# motors to commands that are sent in a row are one answer, or some of them, depending on how the operating system
# hands them over. A pseudo-terminal answers here as the adapter of Damiao does, in frames of 16 bytes as the driver
# itself describes them.
# For us: command and read one motor at a time, or use an adapter of SocketCAN.
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


def answer(motor):
    return b'\xaa\x11\x08' + motor.to_bytes(4, 'big') + bytes([motor]) * 8 + b'\x55'


def received(bus):
    identifiers = []
    while (message := bus.recv(timeout=0.5)) is not None:
        identifiers.append(message.arbitration_id)
    return identifiers


with can.Bus(interface='damiao', channel=os.ttyname(host), bitrate=1000000) as bus:
    os.write(device, b''.join(answer(motor) for motor in range(1, 7)))
    together = received(bus)
    one_by_one = []
    for motor in range(1, 7):
        os.write(device, answer(motor))
        one_by_one += received(bus)
print('together', together, 'one by one', one_by_one)
assert together == [1] and one_by_one == [1, 2, 3, 4, 5, 6]
PYTHON

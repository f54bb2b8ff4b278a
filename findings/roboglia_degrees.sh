#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# roboglia 0.1.0: a moving joint that takes an AX-12A's position in degrees stays at -150.1°, or at its last raw read.
#
# Expected: a register that no loop keeps up to date is read from the device when its value is asked for, as the
# documentation of `value` has it, also a position in degrees. What happens: registers in other units, as
# `present_position_deg` and those of speeds and loads of AX and MX servos, are clones of the raw register, and never
# get what is read, not even by their `read()`. A joint that takes its position from one shows that of 0 counts until
# somebody reads the raw register, and then that reading for good. A fake servo on a pseudo terminal answers here,
# after the control table of the AX-12A.
# For us: read `present_position.value` first, or run a loop that reads the raw registers.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check roboglia==0.1.0 dynamixel-sdk==4.1.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import os
import pty
import threading
import tty

import roboglia.dynamixel
from roboglia.base import BaseRobot

PRESENT_POSITION = 36
memory = bytearray(64)
read = []
controller, device = pty.openpty()
tty.setraw(controller)
tty.setraw(device)


def servo():
    received = b''
    while True:
        received += os.read(controller, 256)
        while len(received) >= 4 and len(received) >= 4 + received[3]:
            packet, received = received[:4 + received[3]], received[4 + received[3]:]
            data = b''
            if packet[4] == 2:
                read.append(packet[5])
                data = bytes(memory[packet[5]:packet[5] + packet[6]])
            body = bytes([packet[2], len(data) + 2, 0]) + data
            os.write(controller, b'\xff\xff' + body + bytes([~sum(body) & 255]))


threading.Thread(target=servo, daemon=True).start()
robot = BaseRobot(
    name='arm',
    buses={'bus': {'class': 'DynamixelBus', 'port': os.ttyname(device), 'baudrate': 1000000, 'protocol': 1.0}},
    devices={'servo': {'class': 'DynamixelDevice', 'bus': 'bus', 'dev_id': 1, 'model': 'AX-12A'}},
    joints={'elbow': {'class': 'Joint', 'device': 'servo', 'pos_read': 'present_position_deg',
                      'pos_write': 'goal_position_deg', 'auto': False}})
robot.start()
elbow, registers = robot.joints['elbow'], robot.devices['servo']
seen = []


def look(counts, before):
    memory[PRESENT_POSITION:PRESENT_POSITION + 2] = counts.to_bytes(2, 'little')
    before()
    seen.append((counts, round(elbow.position, 1)))


look(512, lambda: None)
look(612, registers.present_position_deg.read)
look(612, lambda: registers.present_position.value)
look(812, lambda: None)
look(812, registers.present_position_deg.read)
robot.stop()
print('counts of the servo (512 is 0°, 3.41 are 1°) and the position of the joint in degrees:', seen)
print('reads of the position on the bus:', len(read))
assert seen == [(512, -150.1), (612, -150.1), (612, 29.3), (812, 29.3), (812, 29.3)]
assert read == [PRESENT_POSITION] * 3
PYTHON

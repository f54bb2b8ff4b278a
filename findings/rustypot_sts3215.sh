#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rustypot 1.13.1: an STS3215 at -3.30 rad is read at -53.25 rad, and a goal of -3.30 rad is sent as -53.25 rad.
#
# Positions of this servo have 4096 steps a turn, 2048 for 0 rad, and their sign in bit 15: 100 steps below 0 is 32868
# (see st3215_registers.sh). Expected: -3.2950 rad for it, and 32868 as the goal for -3.2950. What happens: positions
# and goals are in two's complement, so that a goal is read back right although the servo has another one. Speeds have
# their sign, but a turn of 4095 steps: 0.02 % too much. A load has its sign in bit 10: -100 is read as 1124.
# For us: keep the servo between -π and π, or decode read_raw_present_position() & 0xFFFF by its sign bit.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check rustypot==1.13.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import math
import os
import pty
import threading
import tty

from rustypot import Sts3215PyController

GOAL, POSITION, SPEED, LOAD = 42, 56, 58, 60
READ, WRITE = 2, 3
servo, line = pty.openpty()
for end in (servo, line):
    tty.setraw(end)
registers = bytearray(256)


def serve():
    """Answer each packet: FF FF, address, length, instruction, parameters, checksum."""
    waiting = b''
    while True:
        waiting += os.read(servo, 256)
        while len(waiting) > 3 and len(waiting) >= waiting[3] + 4:
            packet, waiting = waiting[: waiting[3] + 4], waiting[waiting[3] + 4 :]
            address, instruction, register, data = packet[2], packet[4], packet[5], b''
            if instruction == READ:
                data = registers[register : register + packet[6]]
            elif instruction == WRITE:
                registers[register : register + len(packet) - 7] = packet[6:-1]
            answer = bytes([address, len(data) + 2, 0]) + data
            os.write(servo, b'\xff\xff' + answer + bytes([~sum(answer) & 0xFF]))


threading.Thread(target=serve, daemon=True).start()
bus = Sts3215PyController(os.ttyname(line), 1_000_000, 1.0)
angle = (-100 - 2048) / 4096 * math.tau

registers[POSITION : POSITION + 2] = (100 | 1 << 15).to_bytes(2, 'little')
registers[SPEED : SPEED + 2] = (2048 | 1 << 15).to_bytes(2, 'little')
registers[LOAD : LOAD + 2] = (100 | 1 << 10).to_bytes(2, 'little')
[position] = bus.read_present_position(1)
[speed] = bus.read_present_speed(1)
[load] = bus.read_present_load(1)
bus.write_goal_position(1, angle)
goal = int.from_bytes(registers[GOAL : GOAL + 2], 'little')
print('angle', angle, 'read as', position, 'sent as', goal, 'speed', speed, 'load', load)
assert abs(position - (-32668 - 2048) / 4096 * math.tau) < 1e-9
assert abs(speed + 2048 / 4095 * math.tau) < 1e-9
assert load == 1124
assert goal == 65436  # which the servo takes for -32668
assert abs(bus.read_goal_position(1)[0] - angle) < 2e-3
PYTHON

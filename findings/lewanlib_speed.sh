#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# lewanlib 0.1.1: a servo that is to move by 240° at 1°/s moves at 8°/s, and one sent beyond its end too slowly.
#
# Expected of move_speed_write, which "moves to angle at a specific speed": the given speed, or an error, as for a speed
# of 0. What happens: it computes the time from the way and the speed, and then bounds the time to the 30 s that the
# servo takes at most, and the goal to 240°, each by itself and without a word. From 0° to 240° at 1°/s are 30 s instead
# of 240 s; from 200° to 300° at 10°/s are 10 s for the 40° that are left, 4°/s. Other moves are right to the rounding.
# The serial port is a stub.
# For us: a slow move, as for calibration, is too fast. Move in parts of at most 30 s each.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check lewanlib==0.1.1
HOME="$folder" timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct

from lewanlib.bus import ServoBus


class Servo:
    """A servo that knows its place in ticks (1000 for 240°) and keeps the goal and the time that it is sent."""

    def __init__(self, angle):
        self.ticks, self.goal, self.answer = round(angle * 1000 / 240), None, b''

    def write(self, packet):
        servo, _, command = packet[2:5]
        if command == 1:  # SERVO_MOVE_TIME_WRITE
            self.goal = struct.unpack('<HH', packet[5:9])
        else:
            assert command == 28  # SERVO_POS_READ
            body = bytes([servo, 5, command]) + struct.pack('<h', self.ticks)
            self.answer = b'\x55\x55' + body + bytes([~sum(body) & 0xff])

    def read(self, size):
        found, self.answer = self.answer[:size], self.answer[size:]
        return found


def speed(start, goal, wanted):
    servo = Servo(start)
    ServoBus(serial_conn=servo, discard_echo=False).move_speed_write(1, goal, wanted)
    ticks, milliseconds = servo.goal
    found = abs(ticks - servo.ticks) * 240 / milliseconds
    print(f'from {start}° to {goal}° at {wanted}°/s: to {ticks * 0.24:g}° in {milliseconds / 1000:g} s, {found:.3f}°/s')
    return found


assert abs(speed(0, 240, 10) - 10) < 1e-9
assert abs(speed(0, 24, 1) - 1) < 1e-9
assert abs(speed(0, 240, 1) - 8) < 1e-9
assert abs(speed(240, 120, 1) - 4) < 1e-9
assert abs(speed(200, 300, 10) - 4) < 0.02
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# EZMotionMMS2 1.0.2: a servo that stands at its goal of 1° is read at 0°, and one degree less for 352 of 359 goals.
#
# These servos count 65536 a turn, and 1° is sent as 182 counts, which are 0.9998°. Expected of Read_Actual_Position():
# 0.9998°. What happens: the angle is cut off to a whole degree, so that 0 comes back and a goal is never seen to be
# reached. Back of 0 the turns and the angle are taken from 65535 instead of 65536: -182 counts are 0 turns and 0°.
# Speeds are whole rpm, so that an output of 0.9 rpm stands still. With limit=False a negative torque is an error. A
# table of registers answers here as a servo does.
# For us: read the register 0x6640 by Read_32bit_Reg(0x6640, True), in counts.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check EZMotionMMS2==1.0.2 minimalmodbus==2.1.1 pyserial==3.5
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import contextlib
import io

from EZMotionMMS2 import EZMotionMMS2

TARGET, POSITION, VELOCITY = 0x67A0, 0x6640, 0x66C0


class Servo(dict):
    """Stands at its goal."""

    def write_long(self, register, value, signed, byteorder):
        self[POSITION if register == TARGET else register] = value

    def read_long(self, register, signed, byteorder):
        return self[register]


motor = EZMotionMMS2.Ezm.__new__(EZMotionMMS2.Ezm)
motor.Ezm = Servo()


def read_back(angle, direction):
    motor.Set_Target_Position(0, angle, direction)
    with contextlib.redirect_stdout(io.StringIO()):  # it prints each value
        return motor.Read_Actual_Position()


for direction in ('CCW', 'CW'):
    print(direction, 'goals of 1, 30 and 90°:', [read_back(angle, direction) for angle in (1, 30, 90)], 'counts', motor.Ezm[POSITION])
less = sum(read_back(angle, 'CCW') == (0, angle - 1) for angle in range(1, 360))
print('read one degree less:', less, 'of 359')
assert read_back(1, 'CCW') == (0, 0) and read_back(90, 'CCW') == (0, 90)
assert read_back(1, 'CW') == (0, 0) and read_back(90, 'CW') == (0, -89)
assert less == 352
motor.Ezm[VELOCITY] = round(0.9 / 60 * 65536)
print('0.9 rpm:', motor.Read_Actual_Velocity())
assert motor.Read_Actual_Velocity() == 0
PYTHON

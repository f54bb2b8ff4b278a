#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# x42s-stepper 0.2.0, y42-stepper 0.1.0, emm-stepper 1.1.0: 12.6°, which are 112 pulses, are sent as 111.
#
# The three control closed-loop steppers from ZDT, whose firmware Emm takes pulses of 0.1125°, and whose firmware X
# takes steps of 0.1°. Expected: the nearest whole number of them, so that 12.6°, 7 full steps, are 112 pulses. What
# happens: degrees are cut off to pulses, also where the result is whole but for the last bit: 12.6° are 111 pulses, 1°
# are 8 of 8.9, and 0.1° is none, although the answer is that it succeeded. 100 turns by 12.6° end at 1248.75°, 360 by
# 1° at 324°, and those in the other direction likewise. Steps of the firmware X are rounded. A speed of 0.4 rpm is sent
# as 0. A motor is simulated that adds up its moves.
# For us: give pulses=round(degrees / 0.1125) and MotionMode.ABSOLUTE, which does not add errors up.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check x42s-stepper==0.2.0 y42-stepper==0.1.0 \
  emm-stepper==1.1.0 pyserial==3.5
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import emm_stepper
import serial
import x42s_stepper
import y42_stepper

SPEED, MOVE, PULSE, TENTH = 0xF6, 0xFD, 360 / 200 / 16, 0.1


class Motor(serial.Serial):
    """A port with a motor that adds up its relative moves, in pulses or in 0.1°."""

    def __init__(self, step):
        super().__init__()
        self.step, self.steps, self.speed, self.answer = step, 0, None, b''

    @property
    def in_waiting(self):
        return len(self.answer)

    def reset_input_buffer(self):
        self.answer = b''

    def reset_output_buffer(self):
        pass

    flush = reset_output_buffer

    def write(self, frame):
        if frame[1] == MOVE:
            place = 6 if self.step == PULSE else 9
            self.steps += (-1 if frame[2] else 1) * int.from_bytes(frame[place:place + 4], 'big')
        elif frame[1] == SPEED:
            self.speed = int.from_bytes(frame[3:5], 'big')
        self.answer += bytes([frame[0], frame[1], 2, 0x6B])
        return len(frame)

    def read(self, length=1):
        answer, self.answer = self.answer[:length], self.answer[length:]
        return answer


def of_x42s(motor, name):
    return x42s_stepper.X42SDevice(motor, firmware_type=x42s_stepper.FirmwareType[name], auto_test=False)


def of_y42(motor, name):
    return y42_stepper.Y42Device(motor, firmware_type=y42_stepper.FirmwareType[name], auto_test=False)


def turned(device, motor, degrees, times):
    """Where the motor stands in ° after it was turned by some degrees a number of times."""
    move = getattr(device, 'move_position', None) or device.move_degrees
    motor.steps = 0
    assert all([move(degrees, motion_mode=0) for _ in range(times)])
    return motor.steps * motor.step


for make in (of_x42s, of_y42, lambda motor, name: emm_stepper.EmmDevice(motor, auto_test=False)):
    motor = Motor(PULSE)
    device = make(motor, 'EMM_FIRMWARE')
    angles = [turned(device, motor, *move) for move in ((1, 360), (12.6, 100), (-12.6, 100), (0.1, 3600))]
    print(f'{type(device).__name__} with Emm: {angles}')
    assert angles == [324, 1248.75, -1248.75, 0]

for make in (of_x42s, of_y42):
    motor = Motor(TENTH)
    device = make(motor, 'X_FIRMWARE')
    angles = [round(turned(device, motor, *move), 6) for move in ((1, 360), (12.6, 100), (-12.6, 100), (0.1, 3600))]
    print(f'{type(device).__name__} with X: {angles}')
    assert angles == [360, 1260, -1260, 360]

motor = Motor(PULSE)
assert of_x42s(motor, 'EMM_FIRMWARE').jog(speed_rpm=0.4)
print(f'0.4 rpm: {motor.speed}')
assert motor.speed == 0
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# micropython-stepper 1.0.3: a stepper that is sent to 10° steps to and fro for ever, and one that is set to 90° is at
# 0°.
#
# 200 steps a turn make 5.56 steps of 10°. Expected of target_deg(10): the motor stops at 5 or 6 steps. What happens:
# the target stays at 5.56, and as a motor is never there it makes one step on and one back at each tick of its timer,
# 1000 a second here. So it is at each angle that is no whole number of steps; at 9° it stops. overwrite_pos_deg(90),
# which tells the motor after homing where it stands, sets its position to 0, whatever is given.
# For us: give target() a rounded number of steps, and keep the offset in the driver.
#
# The module runs in CPython with a `machine` that counts pulses. Exit code 0: still so. Installs it into a temporary
# folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check micropython-stepper==1.0.3
cd "$folder"
cat > machine.py <<'PYTHON'
class Pin:
    OUT = 1

    def __init__(self, number, mode):
        self.number = number
        self.rises = 0

    def value(self, level):
        self.rises += level


class Timer:
    def __init__(self, number):
        self.callback = None

    def init(self, freq, callback):
        self.callback = callback

    def deinit(self):
        self.callback = None
PYTHON
timeout 60 venv/bin/python - <<'PYTHON'
import machine
from stepper import Stepper


def pulses(angle, ticks=1000):
    step = machine.Pin(1, machine.Pin.OUT)
    motor = Stepper(step, 2, steps_per_rev=200, speed_sps=1000)
    motor.target_deg(angle)
    for _ in range(ticks):
        motor.timer.callback(motor.timer)
    print('to', angle, '°: pulses', step.rises, 'in', ticks, 'ticks, stands at', motor.get_pos_deg(), '°')
    return step.rises


assert pulses(9) == 5
assert pulses(10) == 1000
motor = Stepper(1, 2, steps_per_rev=200)
motor.overwrite_pos_deg(90)
print('told to be at 90°:', motor.get_pos_deg())
assert motor.get_pos_deg() == 0
PYTHON

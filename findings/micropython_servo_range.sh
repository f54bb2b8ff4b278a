#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# micropython-servo 1.0.1: a servo from -90° to 90° stands at its stop when it is sent to 0°, and -90° is a pulse of
# -384 µs.
#
# Servo(pin, min_us=544, max_us=2400, min_deg=-90, max_deg=90). Expected: 544 µs at -90°, 1472 µs at 0°, 2400 µs at 90°.
# What happens: the least angle is not taken off, so that 0° is 544 µs, 90° is 1472 µs, and -90° is -384 µs. read()
# gives the angle that was sent. With a range that begins at 0° all is right.
# For us: give min_deg=0, and add the offset in the driver.
#
# The module runs in CPython with a `machine` that notes each pulse. Exit code 0: still so. Installs it into a temporary
# folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check micropython-servo==1.0.1
cd "$folder"
cat > machine.py <<'PYTHON'
class Pin:
    def __init__(self, number):
        self.number = number


class PWM:
    pulses = []

    def __init__(self, pin):
        self.pin = pin

    def freq(self, hertz):
        self.hertz = hertz

    def duty_ns(self, nanoseconds):
        self.pulses.append(round(nanoseconds / 1000))
PYTHON
timeout 60 venv/bin/python - <<'PYTHON'
import machine
from servo import Servo


def pulses(angles, **limits):
    servo = Servo(0, min_us=544.0, max_us=2400.0, **limits)
    machine.PWM.pulses.clear()
    for angle in angles:
        servo.write(angle)
        assert abs(servo.read() - angle) < 0.01
    print(limits, angles, 'pulses in µs', machine.PWM.pulses)
    return list(machine.PWM.pulses)


assert pulses((0, 90, 180), min_deg=0.0, max_deg=180.0) == [544, 1472, 2400]
assert pulses((-90, 0, 90), min_deg=-90.0, max_deg=90.0) == [-384, 544, 1472]
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# spin-stepper 0.1.0: at the greatest speed that it allows, an L6470 stands still, and 60 000 steps/s² are sent as 393.
#
# Expected: run(max_steps_per_second) runs at 15 625 steps/s, or is an error. What happens: it sends 2^20 as a speed of
# 20 bits, which is 0, and set_speed_limits(max_speed=15625) sends 1024 as a limit of 10 bits, also 0; 15 624 steps/s
# are right. An acceleration of 60 000 steps/s² is sent as 4123 in 12 bits, which is 27; no range is checked. A
# min_speed of 0 is not sent at all. On Python 3.11, which it says to support, it is not even imported. A table of
# registers answers here as the driver does, each as wide as the driver's.
# For us: read each setting back after it is sent.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps spin-stepper==0.1.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import typing

typing.override = getattr(typing, 'override', lambda method: method)  # before Python 3.12 there is none

from spin_stepper import SpinChain

BYTES = {0x04: 3, 0x05: 2, 0x06: 2, 0x07: 2, 0x08: 2}
BITS = {0x04: 20, 0x05: 12, 0x06: 12, 0x07: 10, 0x08: 12}
SPEED = 0x04


class Driver(dict):
    waiting, register, answer = [], 0, []

    def transfer(self, sent):
        (byte,) = sent
        if self.waiting:
            self.waiting = self.waiting[1:]
            self.content = self.content << 8 | byte
            self[self.register] = self.content & ((1 << BITS[self.register]) - 1)
        elif byte >> 5 == 1:
            value = self.get(byte & 0x1F, 0)
            self.answer = list(value.to_bytes(BYTES[byte & 0x1F], 'big'))
        elif byte:
            self.register = SPEED if byte >> 1 == 0x28 else byte
            self.waiting, self.content = [0] * BYTES[self.register], 0
        elif self.answer:
            return [self.answer.pop(0)]
        return [0]


motor = SpinChain(total_devices=1, spi_transfer=Driver(zip(BYTES, [0, 0, 0, 0, 65])).transfer).create(0)
speeds = []
for speed in (1000.0, motor.max_steps_per_second - 1, motor.max_steps_per_second):
    motor.run(speed)
    speeds.append(motor.speed)
print('speeds of 1000, 15624 and', motor.max_steps_per_second, 'steps/s:', speeds)
assert abs(speeds[0] - 1000) < 0.1 and abs(speeds[1] - 15624) < 0.1 and speeds[2] == 0
motor.set_speed_limits(min_speed=0, max_speed=motor.max_steps_per_second)
limits = motor.get_speed_limits()
print('limits of 0 and', motor.max_steps_per_second, 'steps/s:', limits)
assert limits[0] > 15 and limits[1] == 0
motor.set_acceleration(dec=50_000, acc=60_000)
deceleration, acceleration = motor.get_acceleration()
print('50 000 steps/s²:', deceleration, '60 000 steps/s²:', acceleration)
assert abs(deceleration - 50_000) < 20 and abs(acceleration - 393) < 1
PYTHON

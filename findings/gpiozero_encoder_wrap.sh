#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# gpiozero 2.0.1.post3: an encoder of 360 steps, read as an angle by wrap=True and max_steps=180, is off by 1° more
# each turn.
#
# By the documentation of RotaryEncoder(a, b, wrap=True, max_steps=180), the count "wraps around by negation" when it
# "reaches" 180, where its value is 1. Expected: 180 * value is the angle of a shaft whose encoder has 360 steps per
# turn. What happens: only the step after 180 leads to -180, which is the same angle, so that there are 361 positions.
# So after one turn the angle is -1°, after 100 turns -100°, and with 20 steps per turn and max_steps=10 it is off by
# 18° per turn. No max_steps fits an even number of steps, as the number of positions is odd. The pins are those that
# gpiozero has for tests.
# For us: take max_steps=0, which does not limit steps, and compute the angle from them.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check gpiozero==2.0.1.post3
timeout 120 "$folder/venv/bin/python" - <<'PYTHON'
from gpiozero import Device, RotaryEncoder
from gpiozero.pins.mock import MockFactory

Device.pin_factory = MockFactory()


def turns(encoder, a, b, steps):
    for _ in range(steps):
        for pin, high in ((a, False), (b, False), (a, True), (b, True)):
            Device.pin_factory.pin(pin).drive_high() if high else Device.pin_factory.pin(pin).drive_low()


encoder = RotaryEncoder(20, 21, wrap=True, max_steps=180)
angles = []
for _ in range(3):
    turns(encoder, 20, 21, 360)
    angles.append(round(180 * encoder.value, 6))
coarse = RotaryEncoder(22, 23, wrap=True, max_steps=10)
turns(coarse, 22, 23, 20)
unlimited = RotaryEncoder(24, 25, max_steps=0)
turns(unlimited, 24, 25, 360)
print('after 1, 2 and 3 turns', angles, '°; of 20 steps', 180 * coarse.value, '°; unlimited', unlimited.steps, 'steps')
assert angles == [-1.0, -2.0, -3.0] and round(180 * coarse.value, 6) == -18.0 and unlimited.steps == 360
PYTHON

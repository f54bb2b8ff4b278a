#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pyky040 0.1.4: an encoder that is turned back from 0° by one step of 18° is at 359°, and with an inc_callback alone it is dead then.
#
# An encoder of 20 steps a turn shows an angle: setup(scale_min=0, scale_max=359, step=18, loop=True). Expected of a step back from
# 0°: 342°, and of two 324°. What happens: at the end of the scale it is set to the other end, so that it is at 359° and 341°. With
# a scale to 360, where 0 and 360 are two positions of one, each turn ends one step short: 342° after the second, 324° after the third.
# With an inc_callback and no dec_callback the first step back calls None; watch() takes the error
# for the wish to end, logs "Exiting..." and returns, and no further step is counted.
# For us: count with step=1 and a great scale, and take the angle modulo a turn in the driver; give both callbacks.
#
# The pins are those of a stand-in of RPi.GPIO. Exit code 0: still so. Installs the package into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps pyky040==0.1.4
cd "$folder"
mkdir RPi
touch RPi/__init__.py
cat > RPi/GPIO.py <<'PYTHON'
BCM = IN = PUD_DOWN = PUD_UP = LOW = 0
levels = []


class End(BaseException):
    pass


def setmode(mode):
    pass


def setup(pin, direction, pull_up_down):
    pass


def cleanup():
    pass


def input(pin):
    """The levels of CLK, by which time goes on, and DT."""
    if pin == 5:
        if not levels:
            raise End
        input.now = levels.pop(0)
        return input.now[0]
    return input.now[1]
PYTHON
timeout 60 venv/bin/python - 2> /dev/null <<'PYTHON'
from pyky040 import pyky040
from RPi import GPIO


def shown(steps, scale_max=359, **callbacks):
    """What the encoder shows after each step; +1 is a step on, -1 a step back."""
    seen, clock = [], 0
    GPIO.levels[:] = [(0, 0)]
    for step in steps:
        clock = 1 - clock
        GPIO.levels.append((clock, 1 - clock if step > 0 else clock))
    encoder = pyky040.Encoder(CLK=5, DT=6, polling_interval=0)
    encoder.setup(scale_min=0, scale_max=scale_max, step=18, loop=True, chg_callback=seen.append, **callbacks)
    encoder.watch()
    return seen


both = {'inc_callback': lambda angle: None, 'dec_callback': lambda angle: None}
back = shown([-1, -1], **both)
print('two steps back from 0:', back)
assert back == [359, 341]
turns = shown([1] * 60, scale_max=360, **both)
print('after one, two and three turns with a scale to 360:', turns[19::20])
assert turns[19::20] == [360, 342, 324]
alone = shown([1, 1, -1, 1, 1], inc_callback=lambda angle: None)
print('with an inc_callback alone, two on, one back and two on:', alone)
assert alone == [18, 36]
PYTHON

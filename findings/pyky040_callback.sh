#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pyky040 0.1.4: an encoder with an inc_callback but no dec_callback is not counted any more after its first step back.
#
# An encoder of 20 steps a turn shows an angle: setup(scale_min=0, scale_max=342, step=18, loop=True, inc_callback=...).
# By the documentation all arguments are optional. Expected of two steps on, one back and two on: 18°, 36°, 18°, 36°,
# 54°. What happens: the step back asks whether there is an inc_callback, and calls the dec_callback, which is None.
# watch() takes this error for the wish to end, logs "Exiting..." at the level INFO, and returns, so that the angle
# stays at 36° for ever. With both callbacks, or with neither, all five steps are counted.
# For us: give both callbacks, and take the return of watch() as a fault of the encoder.
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


def shown(steps, **callbacks):
    """What the encoder shows after each step; +1 is a step on, -1 a step back."""
    seen, clock = [], 0
    GPIO.levels[:] = [(0, 0)]
    for step in steps:
        clock = 1 - clock
        GPIO.levels.append((clock, 1 - clock if step > 0 else clock))
    encoder = pyky040.Encoder(CLK=5, DT=6, polling_interval=0)
    encoder.setup(scale_min=0, scale_max=342, step=18, loop=True, chg_callback=seen.append, **callbacks)
    encoder.watch()
    print('with', sorted(callbacks), 'two on, one back and two on:', seen)
    return seen


def ignored(angle):
    pass


steps = [1, 1, -1, 1, 1]
assert shown(steps) == shown(steps, inc_callback=ignored, dec_callback=ignored) == [18, 36, 18, 36, 54]
assert shown(steps, inc_callback=ignored) == [18, 36]
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# adafruit-circuitpython-hx711 1.1.2: a torque of -1000 counts is read as 4294966296, and after a tare 1000 as
# -4294966296.
#
# An HX711 gives the signal of a bridge as a number of 24 bits with a sign, so that a torque sensor gives negative
# numbers for one direction. Expected: -1000. What happens: the bits above the 24 are set as for a number of 32 bits
# with a sign, but an integer of Python has no sign bit, so that 2^32 is added to each negative value. Where the zero
# of the bridge is at -100 counts and what read() gives is set as the tare, a torque of 1000 counts is -4294966296,
# while those of the other direction are right. A simulated HX711 takes the place of the pins.
# For us: take the sign yourself, as (value + 2**31) % 2**32 - 2**31, before a tare is subtracted.
#
# Exit code 0: still so. Installs the version into a temporary folder, without Blinka, which wants a board.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps adafruit-circuitpython-hx711==1.1.2
cd "$folder"
printf '%s\n' 'class DigitalInOut: pass' > digitalio.py
for name in "disable_interrupts()" "enable_interrupts()" "delay_us(time)"; do
    echo "def $name: pass" >> microcontroller.py
done
timeout 60 venv/bin/python - <<'PYTHON'
import sys

sys.path.insert(0, '.')
from adafruit_hx711.hx711 import HX711


class Clock:
    def __init__(self):
        self.counts, self.clocks, self.level = 0, 0, False

    @property
    def value(self):
        return self.level

    @value.setter
    def value(self, level):
        self.clocks += level and not self.level
        self.level = level
        if not level and self.clocks >= 25:
            self.clocks = 0  # the next conversion is ready


class Data:
    """Low if a conversion is ready; each clock then shifts out one bit of its 24, the highest first."""

    def __init__(self, clock):
        self.clock = clock

    @property
    def value(self):
        clocks = self.clock.clocks
        return bool(clocks) and (clocks > 24 or bool(self.clock.counts >> (24 - clocks) & 1))


clock = Clock()
sensor = HX711(Data(clock), clock)


def read(counts):
    clock.counts, clock.clocks = counts & 0xFFFFFF, 0
    return sensor.read()


values = [read(counts) for counts in (1000, 1, 0, -1, -1000)]
print('1000, 1, 0, -1, -1000 are read as', values)
assert values == [1000, 1, 0, 2**32 - 1, 2**32 - 1000]
sensor.tare_value_a = read(-100)
tared = [read(counts - 100) for counts in (1000, 50, -1000)]
print('tared, 1000, 50 and -1000 are read as', tared)
assert tared == [1000 - 2**32, 50, -1000]
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# adafruit-circuitpython-hx711 1.1.2: a load of -6 is read as 4294967290.
#
# The HX711 converts the bridge of a load cell or a torque sensor to 24 bits with a sign. Expected of read(): -6 where
# the torque has turned round. What happens: the upper eight bits are filled with ones, as for a signed integer of 32
# bits; but the integers of Python have no fixed size, so that no value is ever negative. A tare is subtracted from that
# number.
# For us: subtract 2**32 from values of 2**31 and more, before the tare.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps adafruit-circuitpython-hx711==1.1.2
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import sys
import types


def nothing(*arguments):
    """Stand for what only a microcontroller does."""


sys.modules['digitalio'] = types.SimpleNamespace(DigitalInOut=object)
sys.modules['microcontroller'] = types.SimpleNamespace(
    disable_interrupts=nothing, enable_interrupts=nothing, delay_us=nothing
)
from adafruit_hx711.hx711 import HX711  # noqa: E402


class Chip:
    """An HX711, which shifts a bit out at each rising edge of its clock, the highest first."""

    def __init__(self, load):
        self.bits = [int(bit) for bit in f'{load & 0xFFFFFF:024b}']
        self.edges, self.high = 0, False

    @property
    def clock(self):
        return self.high

    @clock.setter
    def clock(self, high):
        self.edges += high and not self.high
        self.high = bool(high)
        if self.edges > 24 and not high:
            self.edges = 0  # the next conversion is ready at once

    @property
    def data(self):
        return bool(self.bits[self.edges - 1]) if 1 <= self.edges <= 24 else False


class Pin:
    def __init__(self, chip, name):
        object.__setattr__(self, 'chip', chip)
        object.__setattr__(self, 'name', name)

    value = property(
        lambda self: getattr(self.chip, self.name),
        lambda self, value: setattr(self.chip, self.name, value),
    )


for load, expected in ((6, 6), (8388607, 8388607), (-6, 4294967290), (-8388608, 4286578688)):
    chip = Chip(load)
    sensor = HX711(Pin(chip, 'data'), Pin(chip, 'clock'))
    chip.edges = 0
    read = sensor.read(HX711.CHAN_A_GAIN_128)
    print('load', load, 'is read as', read)
    assert read == expected
PYTHON

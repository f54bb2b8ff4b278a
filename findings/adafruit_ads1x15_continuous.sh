#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# adafruit-circuitpython-ads1x15 3.0.5: in continuous mode, an ADS1115 gives the same voltage for all of its four
# inputs.
#
# An analog encoder, a torque sensor and the current of the motor are at the inputs of an ADS1115. Expected in
# continuous mode, as in version 3.0.4 and before: each AnalogIn reads its own input. What happens: the input that is
# asked for is thrown away, and the one that the chip has is written back to it. After the power came on this is the
# difference between the inputs 0 and 1, so that 2.0 V, 0.5 V and 1.0 V are all read as 1.5 V; after one reading in
# single mode, it is that input for good. Nothing warns. It was seen on real chips, too (issue 112 of the project). A
# simulated chip takes the place of the bus.
# For us: use Mode.SINGLE; continuous mode is right for one input alone that was read in single mode before.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check adafruit-circuitpython-ads1x15==3.0.5 \
    adafruit-blinka==10.0.0 adafruit-circuitpython-busdevice==5.2.17 adafruit-circuitpython-register==1.13.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from adafruit_ads1x15 import ADS1115, AnalogIn
from adafruit_ads1x15.ads1x15 import Mode

VOLTS = 2.0, 0.5, 1.0, 0.0
PAIRS = (0, 1), (0, 3), (1, 3), (2, 3)


class Chip:
    """By the data sheet: register 0 is the conversion, 1 the configuration, 0x8583 after power came on."""

    def __init__(self):
        self.registers, self.pointer = {0: 0, 1: 0x8583, 2: 0x8000, 3: 0x7FFF}, 0

    def convert(self):
        mux = self.registers[1] >> 12 & 7
        volts = VOLTS[mux - 4] if mux >= 4 else VOLTS[PAIRS[mux][0]] - VOLTS[PAIRS[mux][1]]
        full = (6.144, 4.096, 2.048, 1.024, 0.512, 0.256)[self.registers[1] >> 9 & 7]
        self.registers[0] = round(volts / full * 32768) & 0xFFFF

    def try_lock(self):
        return True

    def unlock(self):
        pass

    def writeto(self, address, data, *, start=0, end=None):
        data = bytes(data[start:end])
        self.pointer = data[0] if data else self.pointer
        if len(data) == 3:
            self.registers[data[0]] = int.from_bytes(data[1:], 'big') | (0x8000 if data[0] == 1 else 0)

    def readfrom_into(self, address, into, *, start=0, end=None):
        self.convert()
        into[start : start + 2] = self.registers[self.pointer].to_bytes(2, 'big')

    def writeto_then_readfrom(self, address, out, into, *, out_start=0, out_end=None, in_start=0, in_end=None):
        self.writeto(address, out, start=out_start, end=out_end)
        self.readfrom_into(address, into, start=in_start)


def voltages(ads):
    return [round(AnalogIn(ads, pin).voltage, 2) for pin in range(4)]


fresh = voltages(ADS1115(Chip(), mode=Mode.CONTINUOUS))
ads = ADS1115(Chip())
single = voltages(ads)
AnalogIn(ads, 1).value
ads.mode = Mode.CONTINUOUS
later = voltages(ads)
print('single', single, '; continuous', fresh, '; continuous after input 1', later)
assert single == list(VOLTS) and fresh == [1.5] * 4 and later == [0.5] * 4
PYTHON

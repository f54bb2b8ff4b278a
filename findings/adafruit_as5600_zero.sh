#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# adafruit-circuitpython-as5600 1.0.3: opening an encoder takes away the zero and the range that were burnt into it.
#
# The zero of an AS5600 can be burnt into it three times, so that it is there after each start. Expected: AS5600(bus)
# leaves it, as it leaves the mode of the output. What happens: the constructor sets the zero to 0, the end and the
# range to 4095, the filters, the hysteresis and the power mode to its own defaults. A joint whose zero was burnt at
# 1000 counts stands, with no error, 87.9° beside its zero, until the encoder is switched off; zm_count still says that
# it was burnt. A table of registers answers here as the encoder does, with its angle from its zero.
# For us: write the zero again after the constructor, or keep it in the host and read raw_angle.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check adafruit-circuitpython-as5600==1.0.3 \
    adafruit-blinka==10.0.0 adafruit-circuitpython-busdevice==5.2.17 adafruit-circuitpython-register==1.13.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from adafruit_as5600 import AS5600

SHAFT = 1500


class Encoder:
    def __init__(self):
        self.registers = bytearray(256)
        self.registers[0x00] = 1  # the zero was burnt once
        self.registers[0x01:0x03] = (1000).to_bytes(2, 'big')
        self.registers[0x07:0x09] = (0x0008).to_bytes(2, 'big')  # a hysteresis of 2

    def angle(self):
        zero = int.from_bytes(self.registers[0x01:0x03], 'big')
        self.registers[0x0C:0x0E] = SHAFT.to_bytes(2, 'big')
        self.registers[0x0E:0x10] = ((SHAFT - zero) % 4096).to_bytes(2, 'big')
        return int.from_bytes(self.registers[0x0E:0x10], 'big')

    def try_lock(self):
        return True

    def unlock(self):
        pass

    def writeto(self, address, data, *, start=0, end=None):
        data = bytes(data[start:end])
        if len(data) > 1:
            self.registers[data[0] : data[0] + len(data) - 1] = data[1:]

    def writeto_then_readfrom(self, address, out, into, *, out_start=0, out_end=None, in_start=0, in_end=None):
        self.angle()
        first, size = out[out_start], len(into[in_start:in_end])
        into[in_start : in_start + size] = self.registers[first : first + size]


bus = Encoder()
before = bus.angle()
encoder = AS5600(bus)
print('angle before', before, 'and after', encoder.angle, 'hysteresis', encoder.hysteresis, 'burnt', encoder.zm_count)
assert before == 500 and encoder.angle == 1500
assert encoder.z_position == 0 and encoder.hysteresis == 0 and encoder.zm_count == 1
print('turned by', round((encoder.angle - before) / 4096 * 360, 1), '°')
encoder.z_position = 1000
assert encoder.angle == 500
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# adafruit-circuitpython-l3gd20 2.3.27: over SPI, a shaft that turns at 100°/s is read at 1.75°/s, over I2C rightly.
#
# Expected of gyro, which is documented in rad/s: 1.745 rad/s over either bus. What happens: over I2C, gyro_raw gives
# the counts of the chip, and gyro turns them into degrees and then into radians. Over SPI, gyro_raw has turned the
# counts into radians already, so that they are turned a second time, and each speed is 57.3 times too small;
# gyro_raw itself, "in units rad/s", is in neither unit, 199.47 here. So one sensor at the motor over SPI and one at
# the output over I2C give a ratio that is wrong by a factor of 57.3. Simulated buses take the place of the sensor.
# For us: multiply what is read over SPI by 180/π, and check a slow turn of 90° by its integral.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check adafruit-circuitpython-l3gd20==2.3.27 \
    adafruit-blinka==10.0.0 adafruit-circuitpython-busdevice==5.2.17 adafruit-circuitpython-register==1.13.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import math
import struct

from adafruit_l3gd20 import L3GD20_I2C, L3GD20_SPI

SPEED = 100.0  # °/s about z, and 8.75 m°/s for a count by the data sheet
registers = bytearray(128)
registers[0x0F] = 0xD4
registers[0x28:0x2E] = struct.pack('<hhh', 0, 0, round(SPEED / 0.00875))


class Bus:
    """Both buses of the chip; the bits above 0x3F of a register's number say how it is read."""

    def try_lock(self):
        return True

    def unlock(self):
        pass

    def configure(self, **settings):
        pass

    def write(self, data, *, start=0, end=None):
        self.register = data[0] & 0x3F

    def readinto(self, into, *, start=0, end=None):
        into[:] = registers[self.register : self.register + len(into)]

    def writeto(self, address, data, *, start=0, end=None):
        if end != 0 and len(data):
            self.register = data[0] & 0x3F

    def readfrom_into(self, address, into, *, start=0, end=None):
        size = len(into[start:end])
        into[start : start + size] = registers[self.register : self.register + size]

    def writeto_then_readfrom(self, address, out, into, *, out_start=0, out_end=None, in_start=0, in_end=None):
        self.register = out[out_start] & 0x3F
        self.readfrom_into(address, into, start=in_start, end=in_end)


class Select:
    def switch_to_output(self, value):
        self.value = value


speeds = [math.degrees(sensor.gyro[2]) for sensor in (L3GD20_I2C(Bus()), L3GD20_SPI(Bus(), Select()))]
raw = L3GD20_SPI(Bus(), Select()).gyro_raw[2]
print(f'over I2C {speeds[0]:.2f} °/s, over SPI {speeds[1]:.3f} °/s, as gyro_raw {raw:.2f}')
assert math.isclose(speeds[0], SPEED, rel_tol=1e-4) and math.isclose(speeds[1], SPEED * math.pi / 180, rel_tol=1e-4)
assert round(raw, 2) == 199.47
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# micropython-bmi160 0.1.2: an arm at rest has an acceleration of 0.102 instead of 1 g or 9.81 m/s².
#
# Expected of the acceleration of an IMU at rest: 1 for g, or 9.81 for m/s²; its documentation names no unit. What
# happens in each range: g is divided by 9.80665 instead of multiplied, so that 1 g is 0.102. The tilt of an arm, from
# the ratio of two axes, is right, and each acceleration is 96 times too small in m/s².
# Expected of gyro_range, set to GYRO_RANGE_2000: "GYRO_RANGE_2000". What happens: the names stand in the opposite order
# of their numbers. It reads "GYRO_RANGE_125" then, and "GYRO_RANGE_2000" for 125; GYRO_RANGE_500 alone is itself. The
# rates are right, as the scales have the same names in the same order. No error, no warning.
# For us: multiply an acceleration by 9.80665 ** 2 for m/s², and compare no range by its name.
#
# Exit code 0: still so. Installs the version into a temporary folder, where a module stands in for that of MicroPython,
# and a simulated chip for the bus.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps micropython-bmi160==0.1.2
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct
import sys
from types import SimpleNamespace

sys.modules['micropython'] = SimpleNamespace(const=lambda value: value)
from micropython_bmi160 import bmi160  # noqa: E402

CHIP_ID, GYRO_DATA, ACCEL_DATA, ACCEL_RANGE, GYRO_RANGE = 0x00, 0x0C, 0x12, 0x41, 0x43
COUNTS = {3: 16384, 5: 8192, 8: 4096, 12: 2048}  # for 1 g, by ACCEL_RANGE


class Chip:
    """A BMI160 that turns at 100°/s about z, with 1 g in z."""

    def __init__(self):
        self.registers = bytearray(128)
        self.registers[CHIP_ID], self.registers[ACCEL_RANGE] = 0xD1, 3

    def readfrom_mem(self, address, register, size):
        full = 2000 >> (self.registers[GYRO_RANGE] & 7)
        struct.pack_into('<hhh', self.registers, GYRO_DATA, 0, 0, round(100 / full * 32768))
        struct.pack_into('<hhh', self.registers, ACCEL_DATA, 0, 0, COUNTS[self.registers[ACCEL_RANGE]])
        return bytes(self.registers[register : register + size])

    def writeto_mem(self, address, register, data):
        self.registers[register : register + len(data)] = data


imu = bmi160.BMI160(Chip())
for limit in (bmi160.ACCEL_RANGE_2G, bmi160.ACCEL_RANGE_4G, bmi160.ACCEL_RANGE_8G, bmi160.ACCEL_RANGE_16G):
    imu.acceleration_range = limit
    print('acceleration at rest', imu.acceleration)
    assert abs(imu.acceleration[2] - 1 / 9.80665) < 1e-6
names = {}
for limit in (125, 250, 500, 1000, 2000):
    imu.gyro_range = getattr(bmi160, f'GYRO_RANGE_{limit}')
    names[limit] = imu.gyro_range
    assert abs(imu.gyro[2] - 100) < 0.2
print('names of the ranges', names)
assert list(names.values()) == [f'GYRO_RANGE_{limit}' for limit in (2000, 1000, 500, 250, 125)]
PYTHON

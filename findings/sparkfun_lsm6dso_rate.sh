#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# sparkfun-qwiic-lsm6dso 2.0.0: after begin(), an arm that turns at 100°/s is read at 50°/s, and one at 20 °C at 276 °C.
#
# Expected of read_float_gyro_z() after begin(), which resets the chip: 100°/s. What happens: the reset leaves the chip
# in its range of ±250°/s, at 8.75 mdps a count, while the driver takes a count as 4.375 mdps, that of ±125°/s. Each
# rate is halved until set_gyro_range() is called, although get_gyro_range_dps() rightly gives 250°/s from the start.
# The accelerations are right.
# Expected of read_temp_c(), where a kelvin is 256 counts and 25 °C are 0 counts: 20 °C. What happens: a count below 0
# is taken as one without a sign, so that each temperature below 25 °C is 256 K too high. No error, no warning.
# A simulated chip takes the place of the bus.
# For us: call set_gyro_range() always, and take off 256 K from a temperature above 150 °C.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check sparkfun-qwiic-lsm6dso==2.0.0 \
    sparkfun-qwiic-i2c==2.0.0 smbus2==0.6.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct

from qwiic_lsm6dso import QwiicLSM6DSO

WHO_AM_I, CTRL2_G, CTRL3_C, OUT_TEMP, OUT_GYRO, OUT_ACCEL = 0x0F, 0x11, 0x12, 0x20, 0x22, 0x28
SENSITIVITY = {0: 8.75e-3, 1: 4.375e-3, 2: 17.5e-3, 4: 35e-3, 6: 70e-3}  # °/s a count, by bits 1 to 3 of CTRL2_G


class Chip:
    """An LSM6DSO that turns at 100°/s about z, with 1 g in z, at 20 °C."""

    def __init__(self):
        self.registers = bytearray(128)

    def isDeviceConnected(self, address):
        return True

    def writeByte(self, address, register, value):
        if register == CTRL3_C and value & 1:
            self.registers = bytearray(128)
        else:
            self.registers[register] = value

    def readBlock(self, address, register, size):
        counts = round(100 / SENSITIVITY[self.registers[CTRL2_G] >> 1 & 7])
        self.registers[WHO_AM_I] = 0x6C
        struct.pack_into('<hhh', self.registers, OUT_GYRO, 0, 0, counts)
        struct.pack_into('<hhh', self.registers, OUT_ACCEL, 0, 0, round(1 / 61e-6))
        struct.pack_into('<h', self.registers, OUT_TEMP, (20 - 25) * 256)
        return list(self.registers[register : register + size])

    def readByte(self, address, register):
        return self.readBlock(address, register, 1)[0]

    def readWord(self, address, register):
        return int.from_bytes(self.readBlock(address, register, 2), 'little')


imu = QwiicLSM6DSO(i2c_driver=Chip())
assert imu.begin()
first = imu.read_float_gyro_z(), imu.get_gyro_range_dps()
acceleration, temperature = imu.read_float_accel_z(), imu.read_temp_c()
assert imu.set_gyro_range(imu.FS_G_250dps)
second = imu.read_float_gyro_z(), imu.get_gyro_range_dps()
print(f'100°/s read as {first[0]:.2f} in a range of {first[1]}°/s, after this range was set as {second[0]:.2f}')
print(f'1 g read as {acceleration:.3f} g, 20 °C as {temperature} °C')
assert abs(first[0] - 50) < 0.01 and abs(second[0] - 100) < 0.01 and first[1] == second[1] == 250
assert abs(acceleration - 1) < 1e-3 and temperature == 276
PYTHON

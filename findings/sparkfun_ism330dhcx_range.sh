#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# sparkfun-qwiic-ism330dhcx 2.0.0: once a program has set an IMU to ±2000°/s, the next one reads 100°/s as 12.5°/s.
#
# Expected of begin(), which "initializes this device with default parameters", on a chip that has kept its power since
# an earlier program: the ranges of the chip are set, or read. What happens: the chip is neither reset nor asked, and
# the driver takes it to be in the ranges of its reset, ±250°/s and ±2 g. In the ranges that the earlier program set,
# ±2000°/s and ±8 g, it gives 12.5°/s for 100°/s and 0.25 g for 1 g, although get_gyro_full_scale() is right. So a
# program is right once the power was off, and wrong when another one ran before it.
# Expected of begin(): True, as documented. What happens: None for a chip that is there, and False for one that is not,
# so that `if not imu.begin()` takes each chip as absent. No error, no warning.
# For us: set both ranges, or call device_reset(), after each start, and compare begin() with False.
#
# Exit code 0: still so. Installs the versions into a temporary folder; a simulated chip takes the place of the bus.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check sparkfun-qwiic-ism330dhcx==2.0.0 \
    sparkfun-qwiic-i2c==2.0.0 smbus2==0.6.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct

from qwiic_ism330dhcx import QwiicISM330DHCX

WHO_AM_I, CTRL1_XL, CTRL2_G, OUT_GYRO, OUT_ACCEL = 0x0F, 0x10, 0x11, 0x22, 0x28
RATES = {0: 8.75e-3, 2: 4.375e-3, 4: 17.5e-3, 8: 35e-3, 12: 70e-3, 1: 140e-3}  # °/s a count, by the low bits of CTRL2_G
GRAVITIES = {0: 61e-6, 1: 488e-6, 2: 122e-6, 3: 244e-6}  # g a count, by bits 2 and 3 of CTRL1_XL


class Chip:
    """An ISM330DHCX that turns at 100°/s about z, with 1 g in z."""

    present = True

    def __init__(self):
        self.registers = bytearray(128)
        self.registers[WHO_AM_I] = 0x6B

    def isDeviceConnected(self, address):
        return self.present

    def writeByte(self, address, register, value):
        self.registers[register] = value

    def readByte(self, address, register):
        return self.registers[register]

    def read_block(self, address, register, size):
        counts = round(100 / RATES[self.registers[CTRL2_G] & 15])
        struct.pack_into('<hhh', self.registers, OUT_GYRO, 0, 0, counts)
        counts = round(1 / GRAVITIES[self.registers[CTRL1_XL] >> 2 & 3])
        struct.pack_into('<hhh', self.registers, OUT_ACCEL, 0, 0, counts)
        return list(self.registers[register : register + size])


chip = Chip()
earlier = QwiicISM330DHCX(i2c_driver=chip)
begun = [earlier.begin()]
earlier.set_gyro_full_scale(earlier.kGyroFs2000dps)
earlier.set_accel_full_scale(earlier.kXlFs8g)
later = QwiicISM330DHCX(i2c_driver=chip)
begun.append(later.begin())
readings = [(imu.get_gyro().zData / 1000, imu.get_accel().zData / 1000) for imu in (earlier, later)]
print('100°/s and 1 g in the program that set the ranges', readings[0], 'and in the next one', readings[1])
assert abs(readings[0][0] - 100) < 0.1 and abs(readings[0][1] - 1) < 0.01
assert abs(readings[1][0] - 12.5) < 0.1 and abs(readings[1][1] - 0.25) < 0.01
assert later.get_gyro_full_scale() == later.kGyroFs2000dps
chip.present = False
begun.append(QwiicISM330DHCX(i2c_driver=chip).begin())
print('begin() of a chip that is there, twice, and of one that is not', begun)
assert begun == [None, None, False]
PYTHON

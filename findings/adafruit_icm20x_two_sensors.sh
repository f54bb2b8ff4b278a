#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# adafruit-circuitpython-icm20x 2.1.10: as soon as a second IMU of the other type is opened, the first reads 50°/s for
# 100°/s.
#
# An ICM20649 sits at the motor and an ICM20948 at the output. Expected: each is read by the scale of its own type.
# What happens: the scales stand in classes that both share, AccelRange and GyroRange, and each sensor that is opened
# puts its own in the place of the other's. So the first IMU reads half of its speed and of its acceleration from then
# on, 4.9 m/s² at rest, and a gear of 1:1 seems to double the speed; opened in the other order, it reads twice. A
# range that is chosen later by its name is another one too: RANGE_4G sets 8 g in the first. Nothing warns. Two IMUs
# of one type, and each in a process of its own, are right. A simulated bus takes the place of the sensors.
# For us: use one type of IMU per process.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check adafruit-circuitpython-icm20x==2.1.10 \
    adafruit-blinka==10.0.0 adafruit-circuitpython-busdevice==5.2.17 adafruit-circuitpython-register==1.13.0
timeout 100 "$folder/venv/bin/python" - <<'PYTHON'
import math

from adafruit_icm20x import ICM20649, ICM20948, AccelRange

SPEED, GRAVITY = 100.0, 1.0  # °/s about z, g along z
ACCEL, GYRO, WHO, POWER, MASTER, BANK = 0x2D, 0x33, 0x00, 0x06, 0x17, 0x7F


class Imu:
    """By the data sheets; the counts per g and per °/s follow from the range in bank 2."""

    def __init__(self, identity, per_g, per_degree):
        self.identity, self.per_g, self.per_degree = identity, per_g, per_degree
        self.banks = [bytearray(128) for _ in range(4)]
        self.bank = 0

    def write(self, register, value):
        if register == BANK:
            self.bank = value >> 4
        else:
            self.banks[self.bank][register] = value & 0x7F if (self.bank, register) == (0, POWER) else value

    def read(self):
        zero, scales = self.banks[0], self.banks[2]
        zero[WHO], zero[MASTER] = self.identity, 0x40
        counts = round(GRAVITY * self.per_g / 2 ** (scales[0x14] >> 1 & 3))
        zero[ACCEL + 4 : ACCEL + 6] = counts.to_bytes(2, 'big', signed=True)
        counts = round(SPEED * self.per_degree / 2 ** (scales[0x01] >> 1 & 3))
        zero[GYRO + 4 : GYRO + 6] = counts.to_bytes(2, 'big', signed=True)
        return self.banks[self.bank]


class Bus:
    def __init__(self):
        self.imus = {0x68: Imu(0xE1, 8192, 65.5), 0x69: Imu(0xEA, 16384, 131.0)}

    def try_lock(self):
        return True

    def unlock(self):
        pass

    def writeto(self, address, data, *, start=0, end=None):
        data = bytes(data[start:end])
        for k, value in enumerate(data[1:]):
            self.imus[address].write(data[0] + k, value)

    def writeto_then_readfrom(self, address, out, into, *, out_start=0, out_end=None, in_start=0, in_end=None):
        first, size = out[out_start], len(into[in_start:in_end])
        into[in_start : in_start + size] = self.imus[address].read()[first : first + size]


def reading(imu):
    return round(math.degrees(imu.gyro[2]), 1), round(imu.acceleration[2], 2)


bus = Bus()
motor = ICM20649(bus)
alone = reading(motor)
output = ICM20948(bus)
both = reading(motor), reading(output)
print('°/s and m/s² of the motor alone', alone, '; with the other open', both[0], '; of the output', both[1])
assert alone == (100.0, 9.81) and both == ((50.0, 4.9), (100.0, 9.81))
motor.accelerometer_range = AccelRange.RANGE_4G
assert bus.imus[0x68].banks[2][0x14] >> 1 & 3 == 1  # 8 g in an ICM20649
print('range of 4 g: bits 1, which are 8 g in an ICM20649')
first = ICM20948(Bus())
ICM20649(Bus())
print('opened in the other order', reading(first))
assert reading(first) == (199.7, 19.61)
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mpu9250-jmdev 1.0.12: an IMU whose cable has come off is read at 0°/s, 0 g and 0 °C, as if its arm were at rest.
#
# Expected of readGyroscopeMaster() and the other readings while the bus gives an OSError, as each driver below it does
# if a chip does not answer: this error, or NaN. What happens: it is caught, and each value is 0; getAllData() gives a
# row of zeros with a new time. An arm that turns at 50°/s stands still from then on, and one lost answer is a 0 among
# good readings. configure() tries again up to three times, and gives the error then.
# For us: take a reading whose acceleration is exactly 0 in all three axes as an error: gravity is in each true one.
#
# Exit code 0: still so. Installs the version into a temporary folder; a simulated chip takes the place of the bus.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps mpu9250-jmdev==1.0.12
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct
import sys
from types import SimpleNamespace

ACCEL_OUT = 0x3B


class Chip:
    """An MPU-9250 with a range of ±2 g and ±250°/s, on a bus that can be interrupted."""

    connected = True

    def __init__(self, bus):
        self.registers = bytearray(256)
        readings = struct.pack('>hhhhhhh', 0, 0, 16384, 1336, 0, 0, round(50 / 250 * 32768))  # 1 g, 25 °C, 50°/s
        self.registers[ACCEL_OUT : ACCEL_OUT + len(readings)] = readings

    def write_byte_data(self, address, register, value):
        pass

    def read_i2c_block_data(self, address, register, size):
        if not Chip.connected:
            raise OSError(121, 'Remote I/O error')
        return list(self.registers[register : register + size])


sys.modules['smbus2'] = SimpleNamespace(SMBus=Chip)
from mpu9250_jmdev.mpu_9250 import MPU9250  # noqa: E402
from mpu9250_jmdev.registers import AFS_2G, AK8963_BIT_16, AK8963_MODE_C100HZ, GFS_250  # noqa: E402

imu = MPU9250(gfs=GFS_250, afs=AFS_2G, mfs=AK8963_BIT_16, mode=AK8963_MODE_C100HZ)
imu.configure()


def readings():
    return imu.readAccelerometerMaster(), imu.readGyroscopeMaster(), imu.readTemperatureMaster()


accelerations, rates, temperature = readings()
print('connected', accelerations, rates, temperature)
assert accelerations == [0, 0, 1] and abs(rates[2] - 50) < 0.01 and abs(temperature - 25) < 0.01
Chip.connected = False
print('without its cable', *readings())
assert readings() == ([0, 0, 0], [0, 0, 0], 0)
time, *values = imu.getAllData()
assert time > 0 and len(values) > 12 and not any(values)
PYTHON

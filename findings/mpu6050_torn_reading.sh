#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mpu6050-raspberrypi 1.2: an arm at rest, whose gyroscope flickers by one count, is read at up to 15.6°/s both ways.
#
# Expected of get_gyro_data(): values within a count of those of the chip. What happens: the upper and the lower byte of
# each value are read one after the other by single reads, between which the chip may take a new sample. Only a read of
# several bytes at once, which its register map calls a burst, is of one sample. Where a rate goes from 0 to -1 count in
# between, 0x00 and 0xFF make 255 counts, and 0xFF and 0x00 make -256: 2°/s in the range of ±250°/s, 15.6°/s in that of
# ±2000°/s, for an arm that does not move. Also the accelerations, the temperature and the three axes of a reading are
# of different samples. No error, no warning.
# A simulated chip takes the place of the bus, with a new sample each millisecond and half a millisecond for each byte.
# For us: read the 14 bytes from 0x3B on by smbus2's read_i2c_block_data().
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps mpu6050-raspberrypi==1.2
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import random
import struct
import sys
from collections import Counter
from types import SimpleNamespace

GYRO_OUT, END, BYTE, SAMPLE = 0x43, 0x49, 0.0005, 0.001
noise = random.Random(1)


class Chip:
    """An MPU-6050 at rest, whose gyroscope gives 0 or -1 count by chance."""

    def __init__(self, bus):
        self.registers, self.now, self.sampled = bytearray(128), 0.0003, 0.0

    def write_byte_data(self, address, register, value):
        self.registers[register] = value

    def read_byte_data(self, address, register):
        self.now += BYTE
        while self.now >= self.sampled + SAMPLE:
            self.sampled += SAMPLE
            rates = [noise.choice((0, -1)) for _ in range(3)]
            self.registers[GYRO_OUT:END] = struct.pack('>hhh', *rates)
        return self.registers[register]


sys.modules['smbus'] = SimpleNamespace(SMBus=Chip)
from mpu6050 import mpu6050  # noqa: E402

imu = mpu6050(0x68)
for limit, unit in ((imu.GYRO_RANGE_250DEG, 131), (imu.GYRO_RANGE_2000DEG, 16.4)):
    imu.set_gyro_range(limit)
    counts = Counter(round(imu.get_gyro_data()['z'] * unit) for _ in range(2000))
    print({f'{value / unit:.2f}°/s': number for value, number in sorted(counts.items())})
    assert set(counts) == {0, -1, 255, -256} and min(counts[255], counts[-256]) > 100
PYTHON

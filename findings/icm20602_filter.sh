#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# icm20602 0.2.3: an arm that turns at 100°/s is read at 800°/s once a filter is chosen, and a second calibration undoes
# the first.
#
# Expected of set_dlpf_bandwidth() after set_gyro_sensitivity(SENS_2000DPS): the bandwidth changes, the range stays.
# What happens: the bandwidth is written to GYRO_CONFIG instead of CONFIG, so that the gyroscope has a range of ±250°/s
# then, while the driver still takes its counts as those of ±2000°/s: 100°/s are read as 800°/s, and more than 250°/s
# are cut off. The filter of the gyroscope is not set at all; BW_184HZ, BW_92HZ and BW_41HZ even bypass it, as their
# numbers are the bits for this. In the other order the range is right, and the bandwidth is lost.
# Expected of calibrate_sensor(), called again on a resting arm: the offset of 2°/s as before. What happens: it averages
# readings that are corrected already, and the remainder of 0 replaces the offset, so that the arm turns at 2°/s again.
# A simulated chip takes the place of the bus. No error, no warning.
# For us: choose the filter before the range, write CONFIG by write_register(0x1A, ...), and call uncalibrate_sensors()
# before each calibration.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps icm20602==0.2.3
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct
import sys
from types import SimpleNamespace

CONFIG, GYRO_CONFIG, ACCEL_OUT, GYRO_OUT, READ = 0x1A, 0x1B, 0x3B, 0x43, 0x80
RANGES = 250, 500, 1000, 2000  # °/s, by bits 3 and 4 of GYRO_CONFIG


class Chip:
    """An ICM-20602 on an arm at rest or in motion, whose gyroscope has an offset."""

    def __init__(self):
        self.registers, self.rate, self.offset = bytearray(128), 0.0, 0.0

    def open(self, bus, device):
        pass

    def xfer2(self, data):
        register, *values = data
        if not register & READ:
            self.registers[register] = values[0]
            return data
        full = RANGES[self.registers[GYRO_CONFIG] >> 3 & 3]
        counts = round((self.rate + self.offset) / full * 32768)
        self.registers[GYRO_OUT : GYRO_OUT + 6] = struct.pack('>hhh', 0, 0, max(-32768, min(counts, 32767)))
        self.registers[ACCEL_OUT : ACCEL_OUT + 6] = struct.pack('>hhh', 0, 0, 16384)
        first = register & 0x7F
        return [0, *self.registers[first : first + len(values)]]


sys.modules['spidev'] = SimpleNamespace(SpiDev=Chip)
from icm20602 import ICM20602  # noqa: E402

imu = ICM20602()
chip = imu.spi
chip.rate = 100.0
imu.set_gyro_sensitivity(ICM20602.GyroSensitivity.SENS_2000DPS)
before = imu.read_gyro_data()['z']
imu.set_dlpf_bandwidth(ICM20602.DLPFBandwidth.BW_41HZ)
after = imu.read_gyro_data()['z']
bypass = chip.registers[GYRO_CONFIG] & 3
print(f'100°/s before {before:.1f}, after the filter is chosen {after:.1f}; CONFIG {chip.registers[CONFIG]}')
assert abs(before - 100) < 0.2 and abs(after - 800) < 1 and chip.registers[CONFIG] == 0 and bypass == 3

imu = ICM20602()
chip = imu.spi
chip.offset = 2.0
rates = []
for _ in range(4):
    rates.append(imu.read_gyro_data()['z'])
    imu.calibrate_sensor(samples=3)
print('rate at rest before and after each calibration', [round(rate, 2) for rate in rates])
assert all(abs(rate - expected) < 0.02 for rate, expected in zip(rates, (2, 0, 2, 0)))
PYTHON

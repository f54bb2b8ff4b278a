#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# sparkfun-qwiic-nau7802 2.0.0: the zero of a torque sensor, averaged over 100 readings, is 0 instead of 50000 counts.
#
# Expected of calculate_zero_offset(100): the average of 100 readings, for which the amplifier takes 1.25 s at the 80
# readings a second of begin(), or an error. What happens: get_average() gives up after 1 s and returns 0, the sum so
# far is thrown away, and 0 becomes the zero: a torque of 1000 counts is then read as 51000. The same happens from 11
# readings on at 10 readings a second. It happens to get_weight() as soon as the amplifier gives no more readings, as
# after a reset by a dip of its supply: under a load of 1000 counts the weight is 0.0, as -50000 is cut to 0 by
# default, so that a sensor that has stopped seems to be without a load. A simulated amplifier and clock take the
# place of the bus.
# For us: give get_average() a timeout_ms that is long enough, and take a value of exactly 0 as an error.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check sparkfun-qwiic-nau7802==2.0.0 \
    sparkfun-qwiic-i2c==2.0.0 smbus2==0.6.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from types import SimpleNamespace

import qwiic_nau7802

ZERO, LOAD = 50000, 1000
RATES = {0: 10, 1: 20, 2: 40, 3: 80, 7: 320}


class Amplifier:
    def __init__(self):
        self.registers, self.now, self.read_at = bytearray(32), 0.0, 0.0
        self.counts, self.running = ZERO, True

    def sleep(self, seconds):
        self.now += seconds

    def isDeviceConnected(self, address):
        return True

    def readByte(self, address, register):
        value = self.registers[register]
        if register == 0:
            period = 1 / RATES[self.registers[2] >> 4 & 7]
            ready = self.running and self.now - self.read_at >= period
            value = value & 0b11010111 | 0b00001000 | ready << 5  # powered up, and a conversion is ready
        return value

    def writeByte(self, address, register, value):
        self.registers[register] = value & ~4 if register == 2 else value  # a calibration ends at once

    def readBlock(self, address, register, size):
        self.read_at = self.now
        return list(self.counts.to_bytes(3, 'big', signed=True))


chip = Amplifier()
qwiic_nau7802.time = SimpleNamespace(sleep=chip.sleep, time=lambda: chip.now)
sensor = qwiic_nau7802.QwiicNAU7802(i2c_driver=chip)
assert sensor.begin()
zeros = {}
for readings in (50, 100):
    sensor.calculate_zero_offset(readings)
    zeros[readings] = sensor.get_zero_offset()
chip.counts += LOAD
wrong = sensor.get_weight()
sensor.set_zero_offset(ZERO)
right = sensor.get_weight()
chip.running = False
stopped = sensor.get_weight()
print('zero by number of readings', zeros, '; load of 1000 read as', wrong, '; after the readings stopped', stopped)
assert zeros == {50: ZERO, 100: 0} and (right, wrong, stopped) == (LOAD, ZERO + LOAD, 0.0)
chip.running = True
sensor.set_sample_rate(sensor.NAU7802_SPS_10)
slow = [sensor.get_average(readings) for readings in (8, 11)]
longer = sensor.get_average(11, timeout_ms=2000)
print('8 and 11 readings at 10 a second', slow, '; with a longer timeout', longer)
assert slow == [ZERO + LOAD, 0] and longer == ZERO + LOAD
PYTHON

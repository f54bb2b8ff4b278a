#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# imu-bmi088 1.0.1: a joint at 20 °C is read at 276 °C, and one at -10 °C at 246 °C.
#
# By the data sheet of the BMI088 (registers 0x22 and 0x23) the temperature is a number of eleven bits with a sign: a
# value above 1023 stands for the value less 2048, and 0 is 23 °C. What happens: read_temperature() has no sign, so that
# each temperature below 23 °C is 256 °C too high: 22 °C are read at 278 °C, 20 °C at 276 °C and -10 °C at 246 °C. At
# 23 °C and above it is right. Nothing warns of it.
# For us: take 256 °C off a temperature above 150 °C.
#
# Exit code 0: still so. Installs the version into a temporary folder; the bus is one of the script.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check imu-bmi088==1.0.1
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import bmi088.bmi088 as module


class Bus:
    """Registers of a BMI088 by address and register; `celsius` is the temperature it has."""

    def __init__(self, number):
        self.celsius = 23

    def write_byte_data(self, address, register, value):
        pass

    def read_byte_data(self, address, register):
        number = round((self.celsius - 23) / 0.125) % 2048
        return {0x22: number >> 3, 0x23: (number & 7) << 5}[register]


module.SMBus = Bus
imu = module.BMI088(i2c_bus=1)
read = {}
for celsius in (-10, 20, 22, 23, 30, 60):
    imu.bus.celsius = celsius
    read[celsius] = imu.read_temperature()
print('temperatures in °C and what is read:', read)
assert read == {-10: 246, 20: 276, 22: 278, 23: 23, 30: 30, 60: 60}
PYTHON

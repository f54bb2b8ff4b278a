#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# adafruit-circuitpython-ina228 2.0.5: a limit of 10 A for the current of a motor raises its alert at 0.16 A.
#
# An INA228 at a shunt of 15 mΩ is to raise its alert above 10 A, which are 150 mV. Expected of
# shunt_voltage_overlimit = 0.15: the chip compares with 150 mV; by its data sheet a step of that register is 5 µV, or
# 1.25 µV in the smaller range. What happens: the value is written in steps of 312.5 µV, or 78.125 µV, so that the
# chip compares with 2.4 mV, 62.5 times less, and what is read back is 0.15. After power came on, when the limits are
# ±163.84 mV, both are read as +10.24 V, as the sign of the lower one is lost too; setting a negative one is an error.
# A simulated bus takes the place of the chip.
# For us: give 62.5 times the voltage of the shunt.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check adafruit-circuitpython-ina228==2.0.5 \
    adafruit-blinka==10.0.0 adafruit-circuitpython-busdevice==5.2.17 adafruit-circuitpython-register==1.13.0
cd "$folder"
echo 'const = int' > micropython.py # a module of CircuitPython
timeout 60 venv/bin/python - <<'PYTHON'
import sys

sys.path.insert(0, '.')
from adafruit_ina228 import INA228

SHUNT = 0.015


class Chip:
    """Two bytes a register, as far as they are looked at here; limits of the shunt are in steps of 5 or 1.25 µV."""

    def __init__(self):
        self.registers = {0x00: 0, 0x01: 0xFB68, 0x0B: 1, 0x0C: 0x7FFF, 0x0D: 0x8000, 0x3E: 0x5449, 0x3F: 0x2281}
        self.pointer = 0

    def limit(self):
        return self.registers[0x0C] * (1.25e-6 if self.registers[0x00] & 1 << 4 else 5e-6)

    def try_lock(self):
        return True

    def unlock(self):
        pass

    def writeto(self, address, data, *, start=0, end=None):
        data = bytes(data[start:end])
        self.pointer = data[0] if data else self.pointer
        if len(data) == 3:
            self.registers[self.pointer] = int.from_bytes(data[1:], 'big') & (0x3FFF if self.pointer == 0 else 0xFFFF)

    def writeto_then_readfrom(self, address, out, into, *, out_start=0, out_end=None, in_start=0, in_end=None):
        self.writeto(address, out, start=out_start, end=out_end)
        size = len(into[in_start:in_end])
        into[in_start : in_start + size] = self.registers.get(self.pointer, 0).to_bytes(2, 'big')[:size]


chip = Chip()
sensor = INA228(chip)
sensor.set_calibration(SHUNT, 10.0)
fresh = round(sensor.shunt_voltage_overlimit, 2), round(sensor.shunt_voltage_underlimit, 2)
sensor.shunt_voltage_overlimit = 10 * SHUNT
wide = chip.limit() / SHUNT
back = sensor.shunt_voltage_overlimit
sensor.adc_range = 1
sensor.shunt_voltage_overlimit = 2 * SHUNT
narrow = chip.limit() / SHUNT
print(f'limits of 10 A and 2 A are {wide:.3f} A and {narrow:.3f} A; read back {back:.3f} V; after power came on {fresh} V')
assert round(wide, 3) == 0.16 and round(narrow, 3) == 0.032 and round(back, 3) == 0.15 and fresh == (10.24, 10.24)
PYTHON

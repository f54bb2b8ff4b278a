#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# adafruit-circuitpython-ina3221 1.2.3: a limit for the sum of three motors' currents is set for the supply's voltage.
#
# An INA3221 measures the currents of three motors and raises an alert where their sum, as the voltage of the shunts,
# exceeds a limit. Expected of shunt_voltage_sum_limit = 0.05: register 0x0E has 50 mV. What happens: the value goes
# to register 0x10, the upper limit of the supply's voltage, which is 2.496 V then instead of 10.0 V, while 0x0E keeps
# the 655.32 mV that it has after power came on, as reading the limit back shows. So the motors are not guarded, and
# the pin that says that the supply is up says so at 2.5 V. The limits of the single channels are right. A simulated bus
# takes the place of the chip.
# For us: write the limit by _write_register(0x0E, ...), and read back each limit that was set.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check adafruit-circuitpython-ina3221==1.2.3 \
    adafruit-blinka==10.0.0 adafruit-circuitpython-busdevice==5.2.17
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from adafruit_ina3221 import INA3221


class Chip:
    """Two bytes a register, with the data sheet's values of the limits after power came on."""

    def __init__(self):
        self.registers = {0x00: 0x7127, 0x07: 0x7FF8, 0x0E: 0x7FFE, 0x10: 0x2710, 0x11: 0x2328}
        self.pointer = 0

    def try_lock(self):
        return True

    def unlock(self):
        pass

    def writeto(self, address, data, *, start=0, end=None):
        data = bytes(data[start:end])
        self.pointer = data[0] if data else self.pointer
        if len(data) == 3:
            self.registers[self.pointer] = int.from_bytes(data[1:], 'big') & (0x7FFF if self.pointer == 0 else 0xFFFF)

    def readfrom_into(self, address, into, *, start=0, end=None):
        into[start : start + 2] = self.registers.get(self.pointer, 0).to_bytes(2, 'big')


chip = Chip()
sensor = INA3221(chip)


def limits():
    """Of the sum in steps of 40 µV, and of the supply in steps of 8 mV."""
    return round((chip.registers[0x0E] >> 1) * 40e-6, 5), round((chip.registers[0x10] >> 3) * 8e-3, 3)


before = limits()
sensor.shunt_voltage_sum_limit = 0.05
after = limits()
sensor[0].critical_alert_threshold = 0.5  # A, at 0.05 Ω
print('limits of the sum and of the supply in V:', before, 'before,', after, 'after')
print('read back', sensor.shunt_voltage_sum_limit, '; channel 1 at', round((chip.registers[0x07] >> 3) * 40e-6, 5), 'V')
assert before == (0.65532, 10.0) and after == (0.65532, 2.496)
assert round(sensor.shunt_voltage_sum_limit, 5) == 0.65532 and abs((chip.registers[0x07] >> 3) * 40e-6 - 0.025) < 5e-5
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# PyTmcStepper 0.21.3: a quarter turn over VACTUAL never ends, and back is forward; a TMC5160 in hold mode turns
# backwards.
#
# Expected of run_to_position_revolutions(0.25) with TmcMotionControlVActual: a quarter turn, and of -0.25 one back.
# What happens: the steps are rounded to whole turns, and 0 turns have no end: the motor turns forward on and on in both
# cases, and its position is given as reached. 1.5 turns are 2. With 16 microsteps, 16 turns/s that are set are 1
# turn/s. With TmcMotionControlIntRampGenerator HOLD_MODE is 2, which a TMC5160 takes as velocity mode backwards; hold
# is 3. The speed and the acceleration are sent in microsteps and seconds, but the units of the chip are, at its 12 MHz,
# 0.715 microsteps/s and 65.5 microsteps/s²: 3200 and 3200 are 2289 and 209545. A bus answers here as a driver does.
# For us: drive it over STEP/DIR, or scale the numbers and write RAMPMODE and VACTUAL yourself.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check PyTmcStepper==0.21.3 Mock.GPIO==0.2.0
cd "$folder"
timeout 100 "$folder/venv/bin/python" - <<'PYTHON' 2> log || { cat log; exit 1; }
import time

from tmc_driver import (
    Loglevel,
    MovementAbsRel,
    Tmc2209,
    Tmc5160,
    TmcEnableControlToff,
    TmcMotionControlIntRampGenerator,
    TmcMotionControlVActual,
)
from tmc_driver.com._tmc_com_uart_base import TmcComUartBase
from tmc_driver.motion_control._tmc_mc_int_ramp_generator import RampMode

CLOCK, TURNS_PER_SECOND = 12_000_000, 16
SPEED_UNIT = CLOCK / 2**24
ACCELERATION_UNIT = CLOCK**2 / (512 * 256) / 2**24


class Bus(TmcComUartBase):
    """Keep what is written, with the times; the ramp of a TMC5160 is at its target at once."""

    def __init__(self):
        super().__init__()
        self.registers, self.written = {0x35: 1 << 9}, []

    def init(self):
        pass

    deinit = flush_com_buffer = init

    def read_int(self, addr, tries=10):
        return self.registers.get(addr, 0), None

    def write_reg(self, addr, val):
        self.written.append((time.monotonic(), addr, val))
        if addr != 0x35:
            self.registers[addr] = val
        return True

    def write_reg_check(self, addr, val, tries=10):
        return self.write_reg(addr, val)


def turned(turns):
    bus = Bus()
    driver = Tmc2209(TmcEnableControlToff(), TmcMotionControlVActual(), bus, loglevel=Loglevel.NONE)
    driver.set_microstepping_resolution(16)
    driver.tmc_mc.max_speed_fullstep = TURNS_PER_SECOND * 200
    bus.written.clear()
    driver.tmc_mc.run_to_position_revolutions(turns, MovementAbsRel.RELATIVE)
    speeds = [(at, (val ^ 1 << 23) - (1 << 23)) for at, addr, val in bus.written if addr == 0x22]
    steps = sum(speed * SPEED_UNIT * (end - at) for (at, speed), (end, _) in zip(speeds, speeds[1:]))
    return steps / 3200, speeds[0][1] * SPEED_UNIT / 3200, speeds[-1][1], driver.tmc_mc.current_pos / 3200


for turns in (0.25, -0.25, 1.5):
    moved, speed, last, position = turned(turns)
    print(f'{turns} turns: turned by {moved:.2f} at {speed:.3f} instead of {TURNS_PER_SECOND} turns/s, last VACTUAL {last}, position given as {position}')
    assert position == turns
    assert abs(speed - 1) < 1e-3 and (last > 0 if abs(turns) < 0.5 else last == 0 and moved > 1.9)

bus = Bus()
driver = Tmc5160(TmcEnableControlToff(), TmcMotionControlIntRampGenerator(), bus, loglevel=Loglevel.NONE)
driver.set_microstepping_resolution(16)
ramp = driver.tmc_mc
ramp.max_speed, ramp.acceleration = 3200, 3200
ramp.run_to_position_steps(3200)
speed, acceleration = bus.registers[0x27] * SPEED_UNIT, bus.registers[0x26] * ACCELERATION_UNIT
ramp.set_ramp_mode(RampMode.HOLD_MODE)
print('RAMPMODE for hold', bus.registers[0x20], 'VMAX', speed, 'microsteps/s, AMAX', acceleration, 'microsteps/s²')
assert bus.registers[0x20] == 2 and RampMode.VELOCITY_MODE_NEG == RampMode.VELOCITY_MODE_POS == 1
assert abs(speed - 2289) < 1 and abs(acceleration - 209545) < 100
PYTHON

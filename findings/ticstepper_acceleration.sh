#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# circuitpython-ticstepper 2.0.4: an acceleration of 60 rpm/s is sent to a Tic as 6000 rpm/s, and a second move does
# nothing.
#
# By Pololu's guide the controller takes speeds in steps per 10 000 s, but accelerations in steps per 100 s². The
# library sends both as the first, so that max_accel and max_decel are 100 times as great. Read back, it takes offsets
# of settings for those of variables, by ticlib 0.3.0 both: a current limit of 15 is then a maximum speed of 7550 rpm.
# move(), said to move by the given number of steps, sets the target position: the second move(100) leaves the motor
# where it is. A bus keeps here what is sent, as the controller does.
# For us: a rotor that loses steps by such an acceleration has an offset that looks like a slipped coupling.
#
# Exit code 0: still so. Installs the packages into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check circuitpython-ticstepper==2.0.4 ticlib==0.3.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from circuitpython_ticstepper.i2c import TicMotorI2C
from ticlib import ticlib

OFFSETS = {name: offset for name, offset, *rest in ticlib.VARIABLES}
COMMANDS = {
    code: OFFSETS[name.removeprefix('set_')] for name, code, kind in ticlib.COMMANDS
    if kind == ticlib.THIRTY_TWO_BITS and name.startswith('set_')
}


class Controller:
    def __init__(self):
        self.variables = bytearray(0x100)
        self.variables[OFFSETS['current_limit']] = 15
        self.offset = 0

    def __getitem__(self, name):
        offset = OFFSETS[name]
        return int.from_bytes(self.variables[offset : offset + 4], 'little', signed=True)

    def try_lock(self):
        return True

    def unlock(self):
        pass

    def writeto(self, address, data, *, start=0, end=None):
        data = bytes(data[start:end])
        if data[:1] == bytes([ticlib.GET_VARIABLE_CMD]):
            self.offset = data[1]
        elif data and data[0] in COMMANDS:
            offset = COMMANDS[data[0]]
            self.variables[offset : offset + 4] = data[1:5]

    def writeto_then_readfrom(self, address, out, into, *, out_start=0, out_end=None, in_start=0, in_end=None):
        size = len(into[in_start:in_end])
        into[in_start : in_start + size] = self.variables[self.offset : self.offset + size]


tic = Controller()
motor = TicMotorI2C(tic)
motor.max_speed = 60
motor.max_accel = 60
speed, acceleration = tic['max_speed'] / 10_000, tic['max_acceleration'] / 100
print('steps/s', speed, 'steps/s²', acceleration, 'read back', motor.max_speed, 'rpm')
assert speed == 60 / 60 * 200
assert acceleration == 100 * 60 / 60 * 200
assert abs(motor.max_speed - 7550) < 1
targets = []
for _ in range(2):
    motor.move(100)
    targets.append(tic['target_position'])
print('targets of two moves by 100 steps', targets)
assert targets == [100, 100]
PYTHON

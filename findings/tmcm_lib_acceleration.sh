#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# TMCM-Lib 1.0.0: an acceleration of 400 full steps/s² is set to 233, and a motor that is reversed is said to have -233.
#
# acceleration_moving is "rounded down to the next lower motor acceleration step of the module". Expected: about 400
# after the lines of the README for 256 microsteps, 800 full steps/s and 400 full steps/s². What happens: the ramp
# divisor is kept within one of the pulse divisor, which leaves a_max the values 1, 2, 3 and so on, each 233 full
# steps/s². With a ramp divisor of 8 and a_max 109, which the data sheet of the TMC429 allows, it would be 396. For a
# motor whose direction is reversed, the acceleration that is read is negative, and setting what was read is an error. A
# TMCM-3110 is simulated by its manual.
# For us: read acceleration_moving after it was set, take its absolute value, and expect ramps that last for 1.7 times
# as long.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check TMCM-Lib==1.0.0 pyserial==3.5
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from tmcm_lib import Module, Port

SET, GET, VERSION, DONE = 5, 6, 136, 100
VELOCITY, ACCELERATION, RESOLUTION, RAMP, PULSE, REACHED = 4, 5, 140, 153, 154, 8
CLOCK = 16e6


class Tmcm3110(Port):
    """The axis parameters of a TMCM-3110 behind the binary protocol of TMCL."""

    def __init__(self):
        start = {VELOCITY: 1000, ACCELERATION: 500, RESOLUTION: 8, RAMP: 7, PULSE: 3, REACHED: 1}
        self.parameters = {(motor, number): value for motor in range(3) for number, value in start.items()}

    def _transmit(self, data):
        address, command, number, motor = data[:4]
        value = 0
        if command == VERSION:
            value = 3110 << 16 | 0x010E
        elif command == SET:
            self.parameters[motor, number] = int.from_bytes(data[4:8], 'big', signed=True)
        elif command == GET:
            value = self.parameters.get((motor, number), 0)
        answer = bytes([2, address, DONE, command]) + value.to_bytes(4, 'big', signed=True)
        self.answer = answer + bytes([sum(answer) & 0xFF])

    def _receive(self, length):
        return self.answer


def full_steps(ramp, pulse, a_max, resolution):
    """The acceleration by the data sheet of the TMC429, in full steps/s²."""
    return CLOCK**2 * a_max / 2 ** (ramp + pulse + 29) / 2**resolution


board = Tmcm3110()
motor = Module.construct(board).motors[0]
motor.microstep_resolution = 256
motor.velocity_moving = 800
motor.acceleration_moving = 400
ramp, pulse, a_max, resolution = (board.parameters[0, number] for number in (RAMP, PULSE, ACCELERATION, RESOLUTION))
found = full_steps(ramp, pulse, a_max, resolution)
print(f'400 full steps/s² are set as a_max {a_max}, ramp divisor {ramp}, pulse divisor {pulse}: {found:.1f} full steps/s²')
assert (a_max, ramp, pulse) == (1, 2, 1) and motor.acceleration_moving == found and abs(found - 232.83) < 0.01
finer, least = full_steps(8, pulse, 109, resolution), 2 ** (8 - pulse - 1)
print(f'with a_max 109, which may be {least} or more, and ramp divisor 8: {finer:.1f} full steps/s²')
assert 109 >= least and 396 < finer < 400
motor.direction_reversed = True
read = motor.acceleration_moving
print(f'reversed: {read:.1f} full steps/s²')
assert read == -found
try:
    motor.acceleration_moving = read
except ValueError as error:
    print(error)
else:
    raise AssertionError
PYTHON

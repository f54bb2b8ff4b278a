#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# zdt-stepper 0.1.1: a motor that shall turn counterclockwise turns clockwise, and so does a saved move that is loaded.
#
# JogParams, PositionParams and StartSpeedParams have a direction and a speed or a number of pulses, neither of which
# may be negative in the message: there the direction is the first byte, 0 for clockwise and 1 for counterclockwise, by
# the manual of Emm_V5. What happens: each of them sets the direction anew by the sign of its speed or pulses, so that
# Direction.CCW is replaced by CW wherever they are positive. A number of -500 is sent right, as CCW with 500, but
# from_dict of what to_dict saved of it turns it around, and from_json does so too. A port that only answers stands in
# for the motor.
# For us: give the sign in the speed and in the pulses, and save the numbers yourself.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check zdt-stepper==0.1.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from stepper.commands.move import Jog, Move
from stepper.stepper_core.configs import Direction
from stepper.stepper_core.parameters import DeviceParams, JogParams, PositionParams


class Port:
    """A motor that answers each message with success and keeps the last one."""

    is_open = True

    def write(self, message):
        self.message = message
        self.answer = bytes([message[0], message[1], 0x02, 0x6B])

    def read(self, size):
        taken, self.answer = self.answer[:size], self.answer[size:]
        return taken

    def reset_input_buffer(self):
        pass

    def reset_output_buffer(self):
        pass


port = Port()
device = DeviceParams(serial_connection=port)


def sent(command, parameters):
    """Return the direction that is sent, and the speed of a jog or the pulses of a move."""
    assert command(device, parameters).is_success
    low, high = (3, 5) if command is Jog else (6, 10)
    return 'CW' if port.message[2] == 0 else 'CCW', int.from_bytes(port.message[low:high], 'big')


back = JogParams(speed=-500)
found = {
    'jog CCW at 500': sent(Jog, JogParams(direction=Direction.CCW, speed=500)),
    'move CCW by 3200': sent(Move, PositionParams(direction=Direction.CCW, pulse_count=3200)),
    'jog at -500': sent(Jog, back),
    'jog at -500, saved and loaded': sent(Jog, JogParams.from_dict(back.to_dict())),
}
for name, what in found.items():
    print(f'{name}: sent', *what)
assert list(found.values()) == [('CW', 500), ('CW', 3200), ('CCW', 500), ('CW', 500)], found
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# TMCL 1.1.1: a target of 300 or of -1 microsteps is an error, and a position of -1 is read as 4294967295.
#
# A Trinamic module takes commands of nine bytes, the last of which is the sum of the others in eight bits. Expected:
# each target from -2^31 to 2^31 - 1 can be sent. What happens: the sum is not cut to eight bits, so that struct.error
# is raised where address, command and value together exceed 255: with motor 1, from 250 on, 1/205 of a turn at 256
# microsteps. What is negative is an error too, and is read without its sign, as a speed back of -100 is 4294967196. An
# error that the module answers is a NameError. A line answers here as a module does.
# For us: pytrinamic 0.2.26 sends and reads both right.
#
# Exit code 0: still so. Installs the packages into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps TMCL==1.1.1 pytrinamic==0.2.26 pyserial==3.5
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct

import TMCL
from pytrinamic.tmcl import TMCLRequest


class Module:
    """Keeps its target, and is always there."""

    target = 0

    def write(self, request):
        address, command, kind, motor, value, check = struct.unpack('>BBBBiB', request)
        if command == TMCL.Command.SAP:
            self.target = value
        answer = struct.pack('>BBBBi', 2, address, self.status, command, self.target)
        self.answer = answer + bytes([sum(answer) & 0xFF])

    def read(self, size):
        return self.answer

    status = 100


module = Module()
motor = TMCL.connect(module).get_motor(1)


def attempt(target):
    try:
        motor.axis.target_position = target
    except struct.error as error:
        return f'error: {error}'
    return motor.axis.target_position


found = {target: attempt(target) for target in (0, 249, 250, 51200, -1)}
print(found)
assert found[0] == 0 and found[249] == 249
assert all(str(found[target]).startswith('error') for target in (250, 51200, -1))
module.target = -1
print('a position of -1 is read as', motor.axis.actual_position)
assert motor.axis.actual_position == 4294967295
module.status = 4
try:
    motor.axis.actual_position
except NameError as error:
    print('an error of the module:', error)
else:
    raise AssertionError
sent = [TMCLRequest(1, 5, 0, 0, target).to_buffer() for target in (51200, -1)]
print('pytrinamic', [bytes(request).hex() for request in sent])
assert [struct.unpack('>i', request[4:8])[0] for request in sent] == [51200, -1]
PYTHON

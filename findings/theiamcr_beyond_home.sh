#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# theiamcr 3.5.1: a motor that is sent 431 steps beyond its home switch stops at the switch, and is given as beyond it.
#
# The focus of a TL1250 has its switch at step 7959 and its last step at 8390. Expected of moveAbs(8390) without limits,
# which is documented as a move to the switch and then one of "the additional steps beyond": the motor stands at 8390.
# What happens: the first move is sent with the distance from the switch without its sign, which is to the byte the
# command of moveAbs(7528), 431 steps short of the switch; the additional 431 steps end at the switch. With the limits,
# by which "moves are prevented from exceeding the PI limit position", the motor stays at 7528. In both cases the call
# gives 0, no error, and currentStep is 8390. Goals short of the switch are right. The serial port is a stub.
# For us: no later moveRel of this motor is right until it is homed. Bound each goal by PIStep.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check theiamcr==3.5.1 pyserial==3.5
HOME="$folder" timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import serial

HOME, LAST = 7959, 8390
moves = []


class Board:
    """A board that answers each command with success; its position is what the commands in `moves` make of it."""

    in_waiting = 12
    position = None

    def __init__(self, *arguments, **options):
        pass

    def write(self, command):
        revision = b'\x76\x05\x03\x01\0\0\r'
        self.answer = revision if command[0] == 0x76 else bytes([command[0], 0]).ljust(11, b'\0') + b'\r'
        if command[0] in (0x62, 0x66, 0x73):
            moves.append(bytes(command).hex())
            steps = int.from_bytes(command[2:4], 'big')
            # 0x73: to the switch, which it counts as 0, and by these steps away from it
            Board.position = {0x62: lambda: Board.position - steps, 0x66: lambda: Board.position + steps,
                              0x73: lambda: HOME - steps}[command[0]]()

    def readline(self):
        return self.answer

    def close(self):
        pass


serial.Serial = Board
from TheiaMCR import TheiaMCR  # noqa: E402

mcr = TheiaMCR.MCRControl('stub', logFiles=False)
assert mcr.focusInit(LAST, HOME)
focus = mcr.focus


def go(goal):
    moves.clear()
    error = focus.moveAbs(goal)
    print(f'moveAbs({goal}): {error}, sent {moves}, motor at {Board.position}, currentStep {focus.currentStep}')
    return error, list(moves), Board.position, focus.currentStep


right = go(7528)
assert right[0] == 0 and right[2:] == (7528, 7528)
focus.home()
print('without limits:', focus.setRespectLimits(False))
free = go(LAST)
assert free[0] == 0 and free[1][0] == right[1][0] and free[2:] == (HOME, LAST)
focus.home()
print('with limits:', focus.setRespectLimits(True))
assert go(LAST) == (0, right[1], 7528, LAST)
PYTHON

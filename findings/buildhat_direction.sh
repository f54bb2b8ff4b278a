#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# buildhat 0.9.0: a motor at 10 degrees that is to go anticlockwise to 33.3 degrees goes to -13.3, and one that runs at
# 60 rpm and is to run at 1 rpm goes on at 60 rpm.
#
# A motor of a Raspberry Pi Build HAT is sent to a position between -180 and 180 degrees with direction="anticlockwise".
# Expected: the position that was given, by turning down to it. What happens: which of the two ways is the other one is
# found by comparing two differences of angles as equal numbers, and 33.3 - 10 is not equal in both. Then the shorter
# way itself is taken with the opposite sign, so that the motor stops at a position that nobody named. Whole degrees
# are right; of the 3600 positions in tenths of a degree 1104 are missed.
# The second one: with set_speed_unit_rpm(True), start() keeps the speed in revolutions per second, and compares it with
# the next one in rpm. After start(60), start(1) is taken as no change and is not sent; start(2) is.
# A board that carries out the commands takes the place of the Build HAT.
# Output: anticlockwise to 33.3: at -13.3, to 33: at 33.0; clockwise to 33.3: at 33.3
#         missed from 10 degrees on, of 3600: anticlockwise 1104, clockwise 0
#         rpm after start(60), start(1), start(2): 60, 60, 2
# For us: round positions to whole degrees, and call stop() before a change of the speed in rpm.
#
# Exit code 0: still so. Installs the version into a temporary folder; the board is a stand-in.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps buildhat==0.9.0
cd "$folder"
mkdir stand_in
touch stand_in/serial.py
echo 'class DigitalOutputDevice: pass' > stand_in/gpiozero.py
PYTHONPATH=stand_in timeout 60 venv/bin/python - <<'PYTHON'
import re
import time
from types import SimpleNamespace

from buildhat import Motor
from buildhat.devices import Device

START, LARGE_ANGULAR_MOTOR = 10, 49


class Answers(list):
    """Futures of which each gets the state of the motor at once."""

    def __init__(self, state):
        super().__init__()
        self.state = state

    def append(self, future):
        future.set_result(self.state())


class Board:
    """A Build HAT with one motor, which goes to the end of each ramp, and runs at each speed that is set."""

    def __init__(self):
        self.position, self.speed = float(START), 0.0
        self.connections = [SimpleNamespace(typeid=LARGE_ANGULAR_MOTOR, connected=True, callit=None)]
        self.portftr = [Answers(self.state)]
        self.rampftr = [[]]
        self.motorqueue = [SimpleNamespace(join=lambda: None)]

    def state(self):
        return [0, self.position, (self.position + 180) % 360 - 180]

    def write(self, command):
        text = command.decode()
        if ramp := re.search(r'set ramp (\S+) (\S+) (\S+) 0', text):
            assert abs(float(ramp[1]) * 360 - self.position) < 1e-6
            self.position = float(ramp[2]) * 360
            self.rampftr[0].pop().set_result(True)
        elif speed := re.search(r'; set (\S+)\r', text):
            assert 'pid_diff' in text or self.speed
            self.speed = float(speed[1])


time.sleep = lambda _: None
board = Device._instance = Board()
motor = Motor('A')


def gone(degrees, direction):
    board.position = float(START)
    motor.run_to_position(degrees, direction=direction)
    return round(board.position, 3)


down, whole, up = gone(33.3, 'anticlockwise'), gone(33, 'anticlockwise'), gone(33.3, 'clockwise')
print(f'anticlockwise to 33.3: at {down:.1f}, to 33: at {(whole + 180) % 360 - 180:.1f};',
      f'clockwise to 33.3: at {up:.1f}')
missed = {}
for direction in ('anticlockwise', 'clockwise'):
    goals = [tenth / 10 for tenth in range(-1800, 1800)]
    missed[direction] = [goal for goal in goals if abs((gone(goal, direction) - goal + 180) % 360 - 180) > 0.01]
print(f'missed from {START} degrees on, of 3600:', ', '.join(f'{name} {len(goals)}' for name, goals in missed.items()))

motor.set_speed_unit_rpm(True)
speeds = []
for rpm in (60, 1, 2):
    motor.start(rpm)
    speeds.append(round(board.speed * 60))
print('rpm after start(60), start(1), start(2):', ', '.join(map(str, speeds)))
assert (down, whole, up) == (-13.3, 33 - 360, 33.3)
assert len(missed['anticlockwise']) == 1104 and not missed['clockwise']
assert not any(goal.is_integer() for goal in missed['anticlockwise'])
assert speeds == [60, 60, 2]
PYTHON

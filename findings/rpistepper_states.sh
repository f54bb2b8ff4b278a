#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# RPistepper 0.3a1: a motor of 200 steps a turn needs 300 for a turn, and two of six positions hold nothing.
#
# Motor has the pins of the coils A1, A2, B1 and B2 of a motor with six wires, whose middle taps are at the supply, and
# moves it by a number of steps. Expected: four states, in which one half of A and one half of B have current, each a
# quarter of the period on from the one before. What happens: there are six, and in two of them both halves of one coil
# have current, A1 with A2 and B1 with B2. Their fields cancel, so that the shaft is free there, and lock(), which shall
# hold the last step, holds nothing; a load turns it away. Six steps are a period of four steps of the motor, so that
# positions are too great by a half, and the speed is too low by a third. A stand-in for the pins records the states.
# For us: take 1.5 times the steps of the motor for a turn, and stop only where the number of steps is not 0 or 4 mod 6.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps RPistepper==0.3a1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import cmath
import math
import sys
import types

states = []
pins = types.ModuleType('RPi.GPIO')
pins.BCM, pins.OUT = 'BCM', 'OUT'
pins.setmode = pins.setup = pins.cleanup = lambda *_: None
pins.output = lambda _, state: states.append(tuple(state))
sys.modules['RPi'] = types.ModuleType('RPi')
sys.modules['RPi'].GPIO = sys.modules['RPi.GPIO'] = pins

from RPistepper import Motor

motor = Motor([17, 27, 10, 9], delay=0)
states.clear()
motor.move(300)
fields = [complex(a1 - a2, b1 - b2) for a1, a2, b1, b2 in states]
angles = [round(math.degrees(cmath.phase(field))) % 360 if field else None for field in fields]
print('angles of the field in six steps, in degrees of a period:', angles[:6])
held = [angle for angle in angles if angle is not None]
assert all((after - before) % 360 == 90 for before, after in zip(held, held[1:]))
print(f'300 steps are {len(held)} full steps of the motor, each a quarter of a period')
motor.lock()
print('state that shall hold the shaft after 300 steps, of A1, A2, B1 and B2:', states[-1])
assert angles[:6] == [45, 135, 225, None, 315, None] and len(held) == 200
assert states[-1] == (1, 1, 0, 0)
PYTHON

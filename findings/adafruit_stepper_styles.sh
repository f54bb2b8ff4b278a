#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# adafruit-circuitpython-motor 3.5.0: a step forward after two half steps turns the motor back by 1.5 steps, without
# PWM.
#
# Expected of onestep() with another style than before: a step forward that may be shorter than usual, to align with the
# pattern of the style, as its documentation says and as a motor with microsteps does. What happens with
# microsteps=None: one number counts full steps and half steps alike and is looked up in the table of the new style, of
# 4 or 8 patterns. After two INTERLEAVE steps a SINGLE step forward switches on the coil that is 1.5 steps back, and a
# DOUBLE step the one that is 2 steps away, where the direction is left to chance. With 16 microsteps, a SINGLE step
# after 9 of them is 1.44 steps, not less than 1.
# For us: keep to one style, or step until the pattern of both styles is the same.
#
# Exit code 0: still so. Installs the version into a temporary folder, where three modules stand in for CircuitPython's
# own.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps adafruit-circuitpython-motor==3.5.0
cd "$folder"
mkdir stand_in
echo 'const = int' > stand_in/micropython.py
echo 'class DigitalInOut: pass' > stand_in/digitalio.py
echo 'class PWMOut: pass' > stand_in/pwmio.py
PYTHONPATH=stand_in timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from types import SimpleNamespace

from adafruit_motor import stepper
from adafruit_motor.stepper import DOUBLE, FORWARD, INTERLEAVE, MICROSTEP, SINGLE

HALF_STEPS = 8


def coils():
    return [SimpleNamespace(value=0, duty_cycle=0, frequency=2000) for _ in range(4)]


def patterns(*styles):
    """The coils that are on after each step forward."""
    pins = coils()
    motor = stepper.StepperMotor(*pins, microsteps=None)
    seen = []
    for style in styles:
        motor.onestep(direction=FORWARD, style=style)
        seen.append(tuple(bool(pin.value) for pin in pins))
    return seen


turn = patterns(*[INTERLEAVE] * HALF_STEPS)
assert len(set(turn)) == HALF_STEPS


def last_move(*styles):
    """The last move in half steps, from -3 to 4, which the rotor makes to the pattern of coils that is then on."""
    before, after = (turn.index(pattern) for pattern in patterns(*styles)[-2:])
    return (after - before + 3) % HALF_STEPS - 3


for first, second, expected in ((INTERLEAVE, INTERLEAVE, 1), (SINGLE, SINGLE, 2), (INTERLEAVE, SINGLE, -3), (INTERLEAVE, DOUBLE, 4)):
    move = last_move(first, first, second)
    print(f'after two steps of style {first} one of style {second}: {move / 2} steps')
    assert move == expected

motor = stepper.StepperMotor(*coils(), microsteps=16)
for _ in range(9):
    before = motor.onestep(direction=FORWARD, style=MICROSTEP)
after = motor.onestep(direction=FORWARD, style=SINGLE)
print('with microsteps:', (after - before) / 16, 'steps')
assert (before, after) == (9, 32)
PYTHON

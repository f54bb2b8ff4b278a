#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# adafruit-circuitpython-stspin 1.0.3: a stepper that has made half a turn is at position 0, and its speed of 60 rpm
# becomes 960 rpm when microsteps are switched off.
#
# `position` is documented as the position in steps, from 0 to steps_per_revolution - 1, here 199. Expected with the 16
# microsteps that are set at first: 100 after half a turn. What happens: each microstep counts as one step, and 200 of
# them as a turn, so that after 100 microsteps, 11.25 degrees, the position is 100, and after half a turn 0. Moves by
# step_blocking() are not counted at all. `speed` is documented in revolutions per minute, but kept as the time between
# two pulses: with speed = 60 and then full steps, the pulses for 16 microsteps turn the motor 16 times as fast, and
# `speed` then gives 960.
# Stand-ins for the pins count the pulses, and latch the mode as an STSPIN220 does at the end of its reset.
# Output: pulses 100, turned 11.25 degrees, position 100; pulses 1600, turned 180.00 degrees, position 0
#         pulses 100 by step_blocking(), turned 11.25 degrees, position 0
#         at 60 rpm and 16 microsteps: 3200 pulses/s, 60 rpm; then with full steps: 3200 pulses/s, 960 rpm
# For us: count the pulses in the program, and set the speed again after each change of the mode.
#
# Exit code 0: still so. Installs the version into a temporary folder; the pins are stand-ins.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps adafruit-circuitpython-stspin==1.0.3
cd "$folder"
mkdir stand_in
echo 'const = int' > stand_in/micropython.py
cat > stand_in/digitalio.py <<'PYTHON'
class Direction:
    INPUT, OUTPUT = range(2)


class Pull:
    UP, DOWN = range(2)


class DigitalInOut:
    """A pin that tells the motor each change of its level."""

    def __init__(self, pin):
        self.motor, self.name = pin
        self.direction = self.pull = None

    @property
    def value(self):
        return self.motor.levels[self.name]

    @value.setter
    def value(self, level):
        self.motor.change(self.name, bool(level))
PYTHON
PYTHONPATH=stand_in timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from types import SimpleNamespace

import adafruit_stspin
from adafruit_stspin import STSPIN, Modes

MICROSTEPS = {0b0000: 1, 0b1111: 16}  # as the data sheet has them, by MODE4 to MODE1
STEPS = 200


class Motor:
    """An STSPIN220 and its motor: a rising edge at STEP is a microstep, and the end of a reset latches the mode."""

    def __init__(self):
        self.levels = dict.fromkeys(('step', 'dir', 'mode1', 'mode2', 'reset'), True)
        self.mode, self.pulses, self.turns = 0b1111, 0, 0.0

    def change(self, name, level):
        rises = level and not self.levels[name]
        self.levels[name] = level
        if name == 'reset' and rises:
            self.mode = sum(self.levels[pin] << bit for bit, pin in enumerate(('mode1', 'mode2', 'step', 'dir')))
        elif name == 'step' and rises and self.levels['reset']:
            self.pulses += 1
            self.turns += (1 if self.levels['dir'] else -1) / (STEPS * MICROSTEPS[self.mode])


clock = SimpleNamespace(now=0.0)
clock.monotonic = lambda: clock.now
clock.sleep = lambda seconds: setattr(clock, 'now', clock.now + seconds)
adafruit_stspin.time = clock

motor = Motor()
pin = {name: (motor, name) for name in motor.levels}
driver = STSPIN(pin['step'], pin['dir'], STEPS, pin['mode1'], pin['mode2'], stby_reset_pin=pin['reset'])

rows = []
for pulses in (100, 1500):
    driver.step(pulses)
    rows.append((motor.pulses, motor.turns * 360, driver.position))
print('; '.join('pulses {}, turned {:.2f} degrees, position {}'.format(*row) for row in rows))
start = motor.turns
driver.step_blocking(100)
print(f'pulses 100 by step_blocking(), turned {(motor.turns - start) * 360:.2f} degrees, position {driver.position}')
blocked = round((motor.turns - start) * 360, 6), driver.position


def measured(steps):
    """The pulses per second and the revolutions per minute of a move."""
    begin, pulses, turns = clock.now, motor.pulses, motor.turns
    driver.step(steps)
    time_of_move = (clock.now - begin) * steps / (steps - 1)
    return round((motor.pulses - pulses) / time_of_move), round((motor.turns - turns) * 60 / time_of_move)


driver.speed = 60
driver.step_mode = Modes.STEP_1_16
fine = measured(3200)
driver.step_mode = Modes.STEP_FULL
full = measured(3200)
print('at 60 rpm and 16 microsteps: {} pulses/s, {} rpm; then with full steps: {} pulses/s, {} rpm'.format(
    *fine, *full))
assert [(pulses, round(angle, 6), position) for pulses, angle, position in rows] == [(100, 11.25, 100), (1600, 180, 0)]
assert blocked == (11.25, 0)
assert fine == (3200, 60) and full == (3200, 960) and round(driver.speed) == 960
PYTHON

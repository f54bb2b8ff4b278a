#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# barril 2.2.1: a rotor at 36 000 000°, which are 100 000 turns, is 5.2° short in rad, and a turn is 360.00005°.
#
# Expected of Scalar(36000000, 'dega') in rad: 628318.5307 rad, as by math.radians(), and of a turn ('c') in dega: 360.
# What happens: 628318.44 rad, 0.0907 rad less, and 360.0000519°, as the degree is defined as 0.01745329 rad, whose next
# digits are 2520; a degree per second is as coarse. A rotor that is converted so and then taken modulo one turn is 5.2°
# off after 100 000 turns, as in an hour at 1700 rpm, and 0.05° after 1000 turns. A turn in rad and rpm in rad/s have
# ten digits: 0.00001° after 1000 turns.
# For us: convert degrees by numpy.radians(), or count in turns.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check barril==2.2.1
cat > "$folder/degree.py" <<'PYTHON'
import math

from barril.units import Scalar


def error(value, unit, turns):
    """Give by how many degrees of the rotor a number of turns, given in a unit, is off in radians."""
    found = Scalar(value, unit).GetValue('rad')
    degrees = math.degrees(found - 2 * math.pi * turns)
    print(f'{value} {unit} are {found!r} rad, {degrees:.7f} degrees off')
    return degrees


assert math.isclose(error(36_000_000, 'dega', 100_000), -5.198, rel_tol=1e-3)
assert math.isclose(error(360_000, 'dega', 1000), -0.05198, rel_tol=1e-3)
assert abs(error(1000, 'c', 1000)) < 2e-5
turn = Scalar(1, 'c').GetValue('dega')
speed = Scalar(1, 'dega/s').GetValue('rad/s')
rpm = Scalar(60, 'rpm').GetValue('rad/s')
print(f'a turn is {turn!r} degrees, 1 dega/s is {speed!r} rad/s, 60 rpm are {rpm!r} rad/s')
assert math.isclose(turn - 360, 5.198e-5, rel_tol=1e-3) and speed == 0.01745329 and rpm == 6.283185307
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/degree.py"

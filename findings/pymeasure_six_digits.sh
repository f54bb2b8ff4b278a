#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# PyMeasure 0.16.0: a goal of 1234567 counts is sent to an ESP300 as 1.23457e+06, and one of 359.9999° as 360.
#
# Expected: the goal that is given, as the controller positions rotary stages to 0.0001° and takes counts as units. What
# happens: goals, positions to be defined and limits are written with six significant digits, so that a goal is off by
# up to 5 counts from a million on, and by up to 0.0005° from 100° on, without a warning; the position that is read has
# all digits. A ParkerGV6 has 4000 counts per revolution by its docstrings, but the angle of one turn is 1.8°, that of a
# gear of 1:200, which only a comment in the source tells. An adapter that keeps what is sent replaces the controllers.
# For us: write 'PA' with all digits, by axis.write(); compute angles from counts yourself.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check PyMeasure==0.16.0
timeout 60 "$folder/venv/bin/python" -W ignore::FutureWarning - <<'PYTHON'
from pymeasure.adapters import ProtocolAdapter
from pymeasure.instruments.newport import ESP300
from pymeasure.instruments.parker import ParkerGV6


class Line(ProtocolAdapter):
    def __init__(self):
        super().__init__([])
        self.sent = []

    def _write(self, command, **options):
        self.sent.append(command)


line = Line()
axis = ESP300(line).x
for goal in (1234567, 359.9999, 123.45):
    axis.position = goal
axis.define_position(1234567)
axis.right_limit = 1234567
print(line.sent)
assert line.sent == ['1PA1.23457e+06', '1PA360', '1PA123.45', '1DH1.23457e+06', '1SR1.23457e+06']


class Turned(ParkerGV6):
    def ask(self, command):
        return '*TPE4000'


angle = Turned(Line()).angle
print('one turn of 4000 counts:', angle, '°')
assert abs(angle - 1.8) < 1e-9
PYTHON

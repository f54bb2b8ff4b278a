#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# gpiozero 2.0.1: a RotaryEncoder stops counting at 16 periods, and its position is then wrong for good.
#
# Expected: after 20 periods of both signals forwards and 20 backwards the count is 0 again. What happens: it is 16 after 20
# periods, and -4 at the end, where the shaft is at its start. max_steps is 16 unless it is given, and steps beyond it are
# dropped. With max_steps=0 nothing is dropped. A step is a whole period besides: of its four edges none is counted alone.
# For us: give max_steps=0 for the encoder of a motor, and multiply by the lines of its disc, not by its edges.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check gpiozero==2.0.1.post3
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from gpiozero import Device, RotaryEncoder
from gpiozero.pins.mock import MockFactory

Device.pin_factory = MockFactory()
FORWARDS = ((0, 1), (0, 0), (1, 0), (1, 1))
BACKWARDS = ((1, 0), (0, 0), (0, 1), (1, 1))


def turn(levels, periods):
    for a, b in levels * periods:
        Device.pin_factory.pin(2).drive_low() if a == 0 else Device.pin_factory.pin(2).drive_high()
        Device.pin_factory.pin(3).drive_low() if b == 0 else Device.pin_factory.pin(3).drive_high()


for limits, expected in (({}, [15, 16, -4]), ({'max_steps': 0}, [15, 20, 0])):
    with RotaryEncoder(2, 3, **limits) as encoder:
        counts = []
        for levels, periods in ((FORWARDS, 15), (FORWARDS, 5), (BACKWARDS, 20)):
            turn(levels, periods)
            counts.append(encoder.steps)
    print(limits, 'after 15 and 20 periods, and 20 backwards', counts)
    assert counts == expected
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# elliptec 0.1.0: a stage that is sent to the angle that it reads turns back at half of its positions.
#
# Expected: a stage that is sent to the angle at which it stands stays there. What happens: an angle that is read is
# rounded to 0.0001°, and one that is sent is cut off to a whole pulse instead of rounded. So a stage of 143360 pulses
# per turn, as Thorlabs has them, turns back by one pulse, 0.0025°, at 71361 of them. A stub takes the place of the
# serial line.
# For us: add half a pulse, 0.00126°, to each angle that is sent.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check elliptec==0.1.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import logging

import elliptec

logging.disable()
PULSES = 143360


class Stage:
    position = 0

    def send_instruction(self, instruction, address='0', message=None):
        if instruction == b'in':
            return {'Range': 360, 'Pulse/Rev': PULSES, 'Serial No.': '1', 'Motor Type': 18}
        if instruction == b'ma':
            self.position = message
        return '0', 'PO', self.position


stage = Stage()
rotator = elliptec.Rotator(stage)
turned = 0
for stage.position in range(PULSES):
    before = stage.position
    rotator.set_angle(rotator.get_angle())
    assert stage.position in (before, before - 1)
    turned += stage.position != before
print('sent to the angle that is read:', turned, 'of', PULSES, 'positions turn back')
for stage.position in range(PULSES):
    before = stage.position
    rotator.set_angle(rotator.get_angle() + 180 / PULSES)
    assert stage.position == before
assert turned == 71361
PYTHON

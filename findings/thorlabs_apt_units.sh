#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# thorlabs-apt-device 0.3.8: by the conversions that it documents, 45.6° are read as 45°, and 2.4 mm/s as 1200.
#
# Expected: its module `utils` shows how to build conversions from counts, and they give what was sent: to_mm =
# partial(from_pos, factor=1/34304), to_mmps = partial(from_vel, factor=1/34304, t=2048/6e6). What happens: from_pos()
# cuts its result to a whole number, so that 12.34 mm are read as 12, and 45.6° of a stage of 1919.6418578623391 counts
# per degree as 45. from_vel() multiplies by t 65536 once more instead of dividing by it, so that 2.4 mm/s are read as
# 1200. The functions to_pos() and to_vel() of the same module are right; goals are cut to the count below.
# For us: use to_pos(), to_vel() and to_acc() for what is read.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check thorlabs-apt-device==0.3.8
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from functools import partial

from thorlabs_apt_device import utils

MM, DEGREE, TIME = 34304, 1919.6418578623391, 2048 / 6e6
assert 'to_mm = partial(from_pos, factor=1/34304)' in utils.__doc__
assert 'to_mmps = partial(from_vel, factor=1/34304, t=2048/6e6)' in utils.__doc__
to_mm = partial(utils.from_pos, factor=1 / MM)
to_mmps = partial(utils.from_vel, factor=1 / MM, t=TIME)
to_degrees = partial(utils.from_pos, factor=1 / DEGREE)

place, angle = utils.from_pos(12.34, MM), utils.from_pos(45.6, DEGREE)
speed = utils.from_vel(2.4, MM, TIME)
print('12.34 mm:', to_mm(place), 'instead of', round(utils.to_pos(place, MM), 3))
print('45.6°:', to_degrees(angle), 'instead of', round(utils.to_pos(angle, DEGREE), 3))
print('2.4 mm/s:', to_mmps(speed), 'instead of', round(utils.to_vel(speed, MM, TIME), 3))
assert (to_mm(place), to_degrees(angle), to_mmps(speed)) == (12, 45, 1200)
PYTHON

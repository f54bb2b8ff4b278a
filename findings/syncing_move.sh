#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# syncing 1.0.9: the delay of 250 ms of an output that moves by 1 rad is found as 0, and a NaN makes 5 s of it.
#
# Two records of one motion, 10 s at 100 Hz, the second one 250 ms later. For a joint that moves by 1 rad and back, the
# shift is right. Expected of a move of 1 rad that ends there: 0.25 s as well. What happens: the records are correlated
# in a circle, as if their end went on with their beginning, where such a motion jumps by 1 rad, and the shift is 0.
# If one reading is NaN, as an encoder marks a fault, the shift is 4.995 s, half of the record. If the clock of the
# second one is 100 s ahead, which is what it is made to find, it is -9.742 s instead of 100.25 s; up to 9 s ahead is
# found. Resampled by 'akima', the angle is 0 rad instead of 1 rad at times for which the second record has no readings;
# 'linear' holds its last angle there. None of it gives a warning.
# For us: leave out NaN, subtract the difference of the first times, and synchronise by speeds instead of angles.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    syncing==1.0.9 schedula==1.6.15 numpy==2.4.6 scipy==1.17.1
cd "$folder"
timeout 100 venv/bin/python - <<'PYTHON'
import numpy as np
from syncing.model import dsp

times = np.arange(0.0, 10.0, 0.01)


def move(times):
    part = np.clip(times - 3.0, 0.0, 1.0)  # from 3 s to 4 s
    return part**2 * (3.0 - 2.0 * part)


def move_and_back(times):
    return 1.0 + move(times) - move(times - 3.0)


def synchronised(motion, ahead=0.0, fault=False, method='linear'):
    later = motion(times - 0.25)
    if fault:
        later[300] = np.nan
    data = {'motor': {'x': times, 'y': motion(times)}, 'output': {'x': times + ahead, 'y': later}}
    found = dsp({'data': data, 'reference_name': 'motor', 'interpolation_method': method})
    shift, angles = round(found['shifts']['output'], 3), found['resampled']['output']['y']
    print(f'{motion.__name__}, {ahead:g} s ahead, fault {fault}, {method}: shift {shift}, last angle {angles[-1]}')
    return shift, angles


assert [synchronised(move_and_back, ahead)[0] for ahead in (0, 9)] == [0.25, 9.25]
assert synchronised(move)[0] == 0.0
assert synchronised(move_and_back, fault=True)[0] == 4.995
assert synchronised(move_and_back, 100)[0] == -9.742
assert synchronised(move_and_back)[1].min() > 0.99
assert synchronised(move_and_back, method='akima')[1][-1] == 0.0
PYTHON

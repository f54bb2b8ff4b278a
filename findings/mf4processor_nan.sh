#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mf4processor 2.0.1: a reading of NaN in an .mf4 is 0 rad in the array and in the .csv, and the .csv has no times.
#
# A shaft that stands at 1.5 rad, with one reading of NaN, as an encoder marks a fault, in a channel of two groups at
# 100 Hz and 10 Hz. Expected of get_signal_as_numpy(): NaN. What happens: the reading is 0.0 rad, which is an angle like
# any other, and convert_channel_to_csv() writes it so; infinity becomes 1.8e308. The .csv has a column Signal_1 without
# times, and of two channels of that name only those of the first group. The documentation names none of it.
# For us: read the file with asammdf, as gearkin does.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    mf4processor==2.0.1 asammdf==8.8.28 numpy==2.4.6 pandas==3.1.1
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import csv

import numpy as np
from asammdf import MDF, Signal
from mf4processor.processor import MF4Processor

record = MDF(version='4.10')
record.append([Signal(np.array([1.5, np.nan, 1.5]), np.array([0.0, 0.01, 0.02]), name='rotor', unit='rad')])
record.append([Signal(np.array([9.0, 9.0]), np.array([0.0, 0.1]), name='rotor', unit='rad')])
record.save('motor.mf4')
assert np.isnan(MDF('motor.mf4').get('rotor', group=0).samples[1])

processor = MF4Processor('motor.mf4')
angles = processor.get_signal_as_numpy('rotor')
processor.convert_channel_to_csv('rotor', 'rotor.csv')
with open('rotor.csv') as file:
    rows = list(csv.reader(file))
print('array', angles, 'table', rows)
assert angles.tolist() == [1.5, 0.0, 1.5]
assert rows == [['Signal_1'], ['1.5'], ['0.0'], ['1.5']]
PYTHON

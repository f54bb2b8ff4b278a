#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# SignalProcessingForCM 0.2.6: the RMS of a vibration of amplitude 1 is 71 in a record of 10 000 samples, and 224 in 100
# 000.
#
# Expected of get_statistics(): an RMS of 0.707 and a crest factor of 1.414 of a sine. What happens: the root of the sum
# of the squares is taken, not of their mean, so that the RMS grows and the crest factor falls with the length of the
# record, here to 0.014. TSA() cuts the samples of a turn to a whole number: at 10 kHz and 1700 rpm, 352.94 become 352,
# and after 100 turns a tooth mesh of 20 a turn has averaged itself away to 0.05 of its amplitude; nothing warns.
# For us: compute the RMS yourself; average over turns only after resampling by the angle.
#
# Exit code 0: still so. Needs Python 3.11, as the package does; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check numpy==1.26.4 scipy==1.14.1
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps SignalProcessingForCM==0.2.6
timeout 100 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from signalprocessingforCM import signalprocessing

rate, speed, teeth = 10_000, 1700, 20
found = {}
for count in (10_000, 100_000):
    vibration = np.sin(2 * np.pi * 50 * np.arange(count) / rate)
    *_, rms, crest = signalprocessing.get_statistics(vibration)
    found[count] = float(rms), float(crest)
print('RMS and crest factor', found, 'expected', np.sqrt(0.5), np.sqrt(2))
assert found == {10_000: (70.7107, 0.0141), 100_000: (223.6068, 0.0045)}
turns = speed / 60 * np.arange(40_000) / rate
mesh = np.cos(2 * np.pi * teeth * turns)
averaged = signalprocessing.TSA(mesh, 100, speed, rate)
grid = np.arange(100 * 512) / 512
tracked = np.interp(grid, turns, mesh).reshape(100, 512).mean(axis=0)
print('amplitude after the average', abs(averaged).max(), 'after resampling by the angle', abs(tracked).max())
assert abs(averaged).max() < 0.1 and abs(tracked).max() > 0.95
PYTHON

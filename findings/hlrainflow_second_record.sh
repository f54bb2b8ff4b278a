#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# HLrainflow 0.0.5: a torque of ±2 N·m that is counted after one of ±50 N·m has swings of 100 N·m, and a record is
# overwritten.
#
# A torque of ±2 N·m at 5 Hz, for 1 s. Expected of SetWave() and Calc(): nine swings of 4 N·m, as a new object gives.
# What happens if the same object has counted a torque of ±50 N·m before: 19 swings, nine of them of 100 N·m, one of 52
# and nine of 4. The peaks of each wave are added to those of the waves before, and are never cleared. And the list that
# is given is changed: equal neighbours are taken out of it, and what follows is moved forward, so that a plot of it, or
# the mean, is wrong afterwards.
# For us: use a new HL() for each record, and give it a copy.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check HLrainflow==0.0.5 numpy==1.26.4
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import numpy as np
from HLrainflow.rainflow import HL

times = np.arange(0, 1, 0.001)
weak, strong = (amplitude * np.sin(2 * np.pi * 5 * times + 0.3) for amplitude in (2, 50))


def counted(counter, wave):
    counter.SetWave(list(wave))
    counter.Calc()
    ranges = np.array(counter.GetRes()[0]).round(2)
    return dict(zip(*(values.tolist() for values in np.unique(ranges, return_counts=True))))


alone = counted(HL(), weak)
used = HL()
first, second = counted(used, strong), counted(used, weak)
print('swings: weak alone', alone, 'strong', first, 'weak after it', second)
assert alone == {4.0: 9} and first == {100.0: 9}
assert second == {4.0: 9, 52.0: 1, 100.0: 9}
torque = [0.0, 10.0, 10.0, -10.0, 10.0, -10.0, 10.0, -10.0, 0.0, 0.0, 0.0]
counter = HL()
counter.SetWave(torque)
counter.Calc()
print('the list afterwards', torque)
assert torque == [0.0, 10.0, -10.0, 10.0, -10.0, 10.0, -10.0, 0.0, 0.0, 0.0, 0.0]
PYTHON

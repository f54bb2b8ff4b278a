#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# opensourceleg 3.5.0: the zero of a load cell, an average of 2000 readings, is as noisy as that of three.
#
# Expected of calibrate() of a DephyLoadcellAmplifier: number_of_iterations readings are averaged, as documented, so
# that the noise of the zero is 1/45 of that of one reading. What happens: each reading is averaged with the zero so
# far, half and half, so that the last one has a weight of 1/2, the one before of 1/4, and all but the last five have 3
# % together. The noise is 0.58 of that of a reading, with 20 as with 2000 readings, and a last reading that is off by
# 100 N shifts the zero by 50 N for good. The other load cell, NBLoadcellDAQ, averages as expected.
# For us: average readings of the unloaded cell yourself, and subtract them.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check opensourceleg==3.5.0 python-can==4.6.1 smbus2==0.6.1
cd "$folder"
timeout 100 venv/bin/python - 2> log <<'PYTHON'
import builtins

import numpy
from opensourceleg.sensors.loadcell import DephyLoadcellAmplifier

builtins.input = lambda prompt: ''
random = numpy.random.default_rng(1)


def noise(shape):
    return 2048.0 + random.normal(0.0, 10.0, shape)


def zero(readings, last=0.0):
    cell = DephyLoadcellAmplifier(calibration_matrix=numpy.eye(6))
    values = noise((readings + 1, 1, 6))
    values[-1] += last
    values = iter(values)
    cell.calibrate(number_of_iterations=readings, data_callback=lambda: next(values))
    return cell._calibration_offset[0]


cell = DephyLoadcellAmplifier(calibration_matrix=numpy.eye(6))
cell.update(data_callback=lambda: 2048.0 + 10.0 * numpy.ones((1, 6)))
one = cell.data[0]
spread = {readings: numpy.std([zero(readings) for _ in range(100)]) / one for readings in (20, 2000)}
off = numpy.mean([zero(2000, last=1000.0) for _ in range(20)]) / (100 * one)
print('noise of the zero against that of a reading', spread, 'weight of the last reading', off)
assert all(abs(ratio - 3**-0.5) < 0.06 for ratio in spread.values()) and abs(off - 0.5) < 0.01
PYTHON

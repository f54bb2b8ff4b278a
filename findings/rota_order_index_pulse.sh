#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rota-order 0.3.0: a shaft at 600 rpm is read at more than 100 000 rpm from a pulse that lasts for less than 1 % of a
# turn.
#
# The index of an encoder or a narrow mark gives a pulse of 5 V once a turn, with a noise of 10 mV. Expected of
# tacho_to_rpm(): 600 rpm, or an error. What happens: as documented, the level and the hysteresis of the trigger are
# found from the 1st and the 99th percentile of the signal. A pulse that is shorter than 1 % of a turn lies above the
# 99th, so that both percentiles, and the level with them, lie in the noise, whose crossings are counted: more than a
# hundred a turn, which make 100 000 rpm and more, also in the middle of the record, without an error or a warning. The
# documentation does not say so. A pulse of 2 % of a turn is right, and without any noise no pulses are found, which is
# an error.
# For us: give level and hysteresis, here 2.5 and 1 V.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check rota-order==0.3.0 numpy==2.4.6 scipy==1.17.1
timeout 100 "$folder/venv/bin/python" - <<'PYTHON'
import warnings

import numpy as np
from rota.speed import tacho_to_rpm

warnings.simplefilter('error')
RATE, RPM, VOLTS, NOISE = 20_000, 600, 5.0, 0.01
times = np.arange(RATE) / RATE


def speed(share, **trigger):
    """Return the median speed in rpm and the number of pulses for pulses of this share of a turn."""
    turn = (times * RPM / 60 + 0.5) % 1.0
    signal = VOLTS * (turn < share) + np.random.default_rng(0).normal(0.0, NOISE, len(times))
    rpm, info = tacho_to_rpm(signal, RATE, return_info=True, **trigger)
    return round(float(np.median(rpm))), len(info['pulse_times'])


wide, narrow, index = speed(0.02), speed(0.008), speed(0.0025)
given = speed(0.0025, level=2.5, hysteresis=1.0)
print('rpm and pulses at 2 %', wide, ', at 0.8 %', narrow, ', at 0.25 %', index, ', with the level given', given)
assert wide == given == (600, 10)
assert narrow[0] > 80_000 and index[0] > 80_000 and min(narrow[1], index[1]) > 1000
PYTHON

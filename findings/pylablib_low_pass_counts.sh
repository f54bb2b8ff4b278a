#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pylablib 1.4.5: behind its low-pass, a shaft that stands at 50 counts is at 0, and one at 1000 counts is at 904.
#
# Expected of low_pass_filter(counts, 100), a low-pass with one pole and a gain of 1 at standstill: a shaft that stands
# still is where its encoder says. What happens to whole numbers, as an encoder counts: the result is kept in the type of
# the trace, and both terms of each step are cut off towards 0. The filter comes to rest as soon as this loses as much as
# a step gains: nearly one time constant of samples, here 96 counts, too close to 0, on both sides of it. A shaft that
# stands within 100 counts of 0 is read at 0. high_pass_filter(), the difference of the two, gives these 96 counts for a
# shaft that never moved. Traces of floats are right. No error, no warning.
# For us: give low_pass_filter(counts.astype(float), ...).
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pylablib==1.4.5 numpy==2.4.6 scipy==1.17.1
timeout 120 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
import pylablib

for position, settled in ((50, 0), (1000, 904), (-1000, -904), (12345, 12261)):
    counts = np.full(5000, position)
    low, high = pylablib.low_pass_filter(counts, 100), pylablib.high_pass_filter(counts, 100)
    print(f'{position} counts: low-pass {low[-1]}, high-pass {high[-1]}')
    assert low[-1] == settled and high[-1] == position - settled
    as_floats = pylablib.low_pass_filter(counts.astype(float), 100)
    assert np.allclose(as_floats, position)
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pylablib 1.4.5: behind its low-pass, a shaft that stands at 50 counts is at 0, and one at 1000 counts is at 904.
#
# Expected of low_pass_filter(counts, 100), a low-pass with one pole and a gain of 1 at standstill: a shaft that stands
# still is where its encoder says. What happens to whole numbers, as an encoder counts: the result keeps the type of the
# trace, and both terms of each step are cut off towards 0. The filter comes to rest where this loses as much as a step
# gains: here 96 counts too close to 0, nearly its time constant in samples, on both sides of 0. A shaft that stands
# within about 100 counts of 0 is read at 0. high_pass_filter(), the difference of the two, gives these 96 counts for a
# shaft that never moved. Traces of floats are right. No error, no warning.
# For us: give low_pass_filter(counts.astype(float), ...).
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --no-compile --disable-pip-version-check \
    numpy==2.4.6 scipy==1.17.1 pandas==3.1.1 numba==0.65.1
"$folder/venv/bin/pip" install --quiet --no-compile --disable-pip-version-check --no-deps pylablib==1.4.5
timeout 120 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from pylablib.core.dataproc import filters

for position, settled in ((50, 0), (1000, 904), (-1000, -904), (12345, 12261)):
    counts = np.full(5000, position)
    low, high = filters.low_pass_filter(counts, 100), filters.high_pass_filter(counts, 100)
    print(f'{position} counts: low-pass {low[-1]}, high-pass {high[-1]}')
    assert low[-1] == settled and high[-1] == position - settled
    as_floats = filters.low_pass_filter(counts.astype(float), 100)
    assert np.allclose(as_floats, position)
PYTHON

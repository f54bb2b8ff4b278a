#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# SciPy 1.17.1: decimate() makes 98.86 rad of a shaft that stands at 100 rad, and resample_poly() 55 rad at its ends.
#
# The default of decimate is a Chebyshev filter of order 8, which passes a constant with -0.05 dB, and is used twice:
# every sample is 1.1 % too small, in the middle of a recording as at its ends. So a gear ratio from a decimated and a
# whole signal is wrong by as much. With ftype='fir', and in resample_poly, the middle is right, but both take the
# signal as 0 before and after: at 100 rad the first two samples are 55.0 and 108.7 rad.
# For us: resample_poly(..., padtype='line') errs nowhere for a steady shaft, nor for one that turns evenly.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check scipy==1.17.1 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from scipy.signal import decimate, resample_poly

steady = np.full(1000, 100.0)
turning = 100 + 0.01 * np.arange(1000)
for name, thin, at_ends, in_the_middle in (
    ('decimate', lambda angle: decimate(angle, 10), 1.1447, 1.1447),
    ('decimate fir', lambda angle: decimate(angle, 10, ftype='fir'), 44.99, 0),
    ('resample_poly', lambda angle: resample_poly(angle, 1, 10), 45.00, 0),
    ('resample_poly line', lambda angle: resample_poly(angle, 1, 10, padtype='line'), 0, 0),
):
    error = np.abs(thin(steady) - 100)
    print(name, thin(steady)[:2], 'error at the ends', error.max(), 'in the middle', error[40:60].max())
    assert abs(error.max() - at_ends) < 1e-2
    assert abs(error[40:60].max() - in_the_middle) < 1e-3
assert np.allclose(resample_poly(turning, 1, 10, padtype='line'), turning[::10])
assert abs(decimate(turning, 10)[50] / turning[500] - 0.98855) < 1e-3
PYTHON

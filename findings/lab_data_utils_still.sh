#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# lab-data-utils 0.2.0: a jump of a still encoder by 1000 counts is no outlier, and three torques become one.
#
# Of 100 readings of a still encoder, 97 are 500, two are next to it and one is 1500. Expected: that one is an outlier
# by each method. What happens: by 'mad' and 'iqr' none is, as all scores are 0 where half of the readings are equal;
# 'z' and 'grubbs' find it, and so do all four in noisy readings. With a NaN among the readings, the mask of outliers is
# shorter than they are, and marks the reading before. propagate() takes "a float, list, or NumPy array" for each value:
# of a ratio of 19 ± 0.1 times three torques it gives one result, that of the first torque, and of 0.01 N·m at an
# inertia of (3 ± 0.1)·10⁻⁹ kg·m² an acceleration with a tenth of its error, as its least step is 1e-8. There is no
# warning.
# For us: judge readings by their distance in counts, and use the package uncertainties.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check lab-data-utils==0.2.0 numpy==2.4.6 scipy==1.17.1 \
    uncertainties==3.2.3
timeout 100 "$folder/venv/bin/python" -W error - <<'PYTHON'
import numpy as np
from labdatautils import detect_outliers, propagate, remove_outliers
from uncertainties import ufloat

still = np.array([500.0] * 97 + [501, 499, 1500])
noisy = 500 + np.random.default_rng(0).normal(0, 1, 100)
noisy[50] = 1500
for method, seen in (('z', True), ('grubbs', True), ('mad', False), ('iqr', False)):
    greatest = [remove_outliers(readings, method=method, verbose=False).max() for readings in (still, noisy)]
    print(method, 'greatest reading left: of a still encoder', greatest[0], 'of a noisy one', greatest[1])
    assert (greatest[0] < 1500) == seen and greatest[1] < 1500

readings = np.array([1.0, np.nan, 1.1, 0.9, 50.0, 1.0, 1.05, 0.95, 1.0, 1.1, 0.9, 1.0, 1.02, 0.98, 1.0])
mask = detect_outliers(readings, method='mad', verbose=False)
print(readings.size, 'readings, mask of', mask.size, 'marks', np.flatnonzero(mask), 'right', np.nanargmax(readings))
assert mask.size == 14 and np.flatnonzero(mask).tolist() == [3] and np.nanargmax(readings) == 4

torques, errors = propagate(lambda ratio, torque: ratio * torque, 19.0, 0.1, [1.0, 2.0, 3.0], [0.1, 0.1, 0.1])
print('output torques', torques, '±', errors)
assert torques.tolist() == [19] and errors.size == 1
acceleration, error = propagate(lambda torque, inertia: torque / inertia, [0.01], [0.0], [3e-9], [1e-10])
right = 0.01 / ufloat(3e-9, 1e-10)
print('acceleration', acceleration[0], '±', error[0], 'right', right)
assert abs(acceleration[0] / right.n - 1) < 1e-9 and abs(error[0] / right.s - 0.0989) < 0.001
PYTHON

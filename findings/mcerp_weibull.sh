#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mcerp 1.1.1: a bearing with a characteristic life of 10 000 h and a Weibull slope of 1.5 has a mean life of 4.6 h.
#
# Weibull(lamda, k) is documented with lamda as the scale and k as the shape. Expected of Weibull(10000, 1.5): a mean
# of 9027 h, and 63.2 % of the bearings failed at 10 000 h; a scale of 20 000 h doubles all lives. What happens: a mean
# of 4.6 h, all failed at 10 h, and twice the scale makes 4.8 h. Lamda is passed to SciPy's exponentiated Weibull
# distribution as its exponent, and the scale is always 1. Only lamda = 1 is right. LogN(mu, sigma) takes mu, the
# "location", as the median: with mu = 0, a usual log-normal factor about 1, it is NaN, and LogN(-1, 0.5) is NaN too.
# For a sister package, soerp, the same Weibull was reported in 2017.
# For us: give the distribution of SciPy itself, as uv(scipy.stats.weibull_min(k, scale=life)).
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mcerp==1.1.1 scipy==1.17.1 numpy==2.4.6
cd "$folder"
timeout 120 venv/bin/python -W ignore - <<'PYTHON'
import math

import numpy as np
import scipy.stats
from mcerp import LogN, Weibull, uv

np.random.seed(1)


def life(value):
    """The mean life in hours, and the shares that have failed at 10 h and at 10 000 h."""
    return round(float(value.mean), 1), round(value < 10.0, 3), round(value < 10_000.0, 3)


found = {
    'Weibull(10000, 1.5)': life(Weibull(10_000.0, 1.5)),
    'Weibull(20000, 1.5)': life(Weibull(20_000.0, 1.5)),
    'SciPy': life(uv(scipy.stats.weibull_min(1.5, scale=10_000.0))),
}
print(found)
right = 10_000.0 * math.gamma(1 + 1 / 1.5)
assert abs(found['SciPy'][0] / right - 1) < 0.01 and found['SciPy'][1:] == (0.0, 0.632)
assert 4.5 < found['Weibull(10000, 1.5)'][0] < 4.7 and 4.7 < found['Weibull(20000, 1.5)'][0] < 5.0
assert all(found[name][1] > 0.99 and found[name][2] == 1.0 for name in list(found)[:2])
assert abs(Weibull(1.0, 1.5).mean / math.gamma(1 + 1 / 1.5) - 1) < 0.01

factors = [float(LogN(mu, 0.5).mean) for mu in (0.0, -1.0, 1.0)]
print('LogN(mu, 0.5) at mu 0, -1 and 1', factors)
assert math.isnan(factors[0]) and math.isnan(factors[1])
assert abs(factors[2] - math.exp(0.125)) < 0.01  # the mean for mu = 0, as 1 is taken as the median
PYTHON

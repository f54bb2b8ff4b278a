#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# upy2 2.4.0: an angle from sine and cosine depends on them with the wrong sign, so an uncertain mean is given as exact.
#
# The package propagates standard deviations through calculations and keeps track of what they have in common. Expected:
# `arctan2(s, c)` and `arctan(s / c)` of the same two voltages are the same angle; their difference is exactly 0, and
# their mean is as uncertain as each. Of two end stops with a common zero error, one on each side of zero, the error
# cancels in the travel `upper + abs(lower)`, and is whole in the doubled centre `upper - abs(lower)`.
# What happens: both derivatives of `arctan2` have the opposite sign, and that of `abs` is +1 for negative values too
# (that of `arccosh` has the opposite sign as well). The standard deviation of the result alone is right, so that this
# is not seen; but whatever is combined with something of the same origin is twice as uncertain, or has no uncertainty.
# Output: arctan2: 30.00 ± 0.66 deg, arctan: 30.00 ± 0.66 deg, difference: ± 1.32, mean: ± 0.00
#         stops at 3.0 and -2.0 ± 0.1 deg: travel 5.0 ± 0.2, doubled centre 1.0 ± 0.0
# For us: take `arctan(s / c)` with the quadrant added by hand, and `-x` instead of `abs(x)` for a negative x.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps upy2==2.4.0 numpy==2.4.6
cd "$folder"
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from upy2 import U, u

U(1).default()  # u(x) has a standard deviation of x.


def deviation(value):
    return round(float(value.stddev), 6)


sine = 0.5 + u(0.01)
cosine = np.sqrt(1 - sine * sine)
by_both, by_ratio = (angle * (180 / np.pi) for angle in (np.arctan2(sine, cosine), np.arctan(sine / cosine)))
difference, mean = by_both - by_ratio, (by_both + by_ratio) / 2
print(f'arctan2: {by_both.nominal:.2f} ± {by_both.stddev:.2f} deg, arctan: {by_ratio.nominal:.2f} ± '
      f'{by_ratio.stddev:.2f} deg, difference: ± {difference.stddev:.2f}, mean: ± {mean.stddev:.2f}')
truth = round(np.degrees(0.01 / np.sqrt(0.75)), 6)
assert deviation(by_both) == deviation(by_ratio) == truth and np.isclose(by_both.nominal, by_ratio.nominal)
assert abs(deviation(difference) - 2 * truth) < 1e-5 and deviation(mean) == 0
assert deviation(by_ratio - np.arcsin(sine) * (180 / np.pi)) == 0  # The others agree with each other.

error = 0.0 + u(0.1)
upper, lower = 3.0 + error, -2.0 + error
travel, centre = upper + abs(lower), upper - abs(lower)
print(f'stops at {upper.nominal} and {lower.nominal} ± {lower.stddev} deg: travel {travel.nominal} ± '
      f'{travel.stddev:.1f}, doubled centre {centre.nominal} ± {centre.stddev:.1f}')
assert (deviation(travel), deviation(centre)) == (0.2, 0)
assert (deviation(upper - lower), deviation(upper + lower)) == (0, 0.2)  # As it should be.

known = 2.0 + u(0.1)
assert deviation(np.arccosh(known) - np.log(known + np.sqrt(known * known - 1))) == round(0.2 / np.sqrt(3), 6)
PYTHON

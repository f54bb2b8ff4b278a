#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# minkf 0.0.5: an encoder's noise of 10 mrad is found as 1 rad by the greatest likelihood, and as 7 mrad by the least.
#
# run_filter() gives as `loglike` the log-likelihood of the data, to be used by an optimizer for the parameters of the
# noise. Expected of 2000 readings of a shaft that stands still: its maximum is at their standard deviation. What
# happens: the value has the opposite sign, so that the maximum is at the greatest noise that is allowed. The minimum
# is wrong too, by a factor of √2, because the squared errors are halved but the logarithm of the determinant is not:
# at 7.1 mrad instead of 10 mrad.
# For us: find the noise from the `yp` and `Cyp` that predict_y=True gives, by the density of a normal distribution.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check minkf==0.0.5 numpy==2.4.6 scipy==1.17.1
timeout 120 "$folder/venv/bin/python" - <<'PYTHON'
import minkf
import numpy as np
from scipy.optimize import minimize_scalar
from scipy.stats import norm

READINGS = 1 + 0.01 * np.random.default_rng(1).standard_normal(2000)
ONE = np.eye(1)


def filtered(noise):
    readings = [np.array([reading]) for reading in READINGS]
    start, initial, process = np.array([1.0]), 1e-12 * ONE, 1e-16 * ONE
    return minkf.run_filter(
        readings, start, initial, ONE, ONE, process, noise**2 * ONE, likelihood=True, predict_y=True
    )


def right(noise):
    result = filtered(noise)
    predicted, variances = np.array(result['yp'])[:, 0], np.array(result['Cyp'])[:, 0, 0]
    return norm.logpdf(READINGS, predicted, np.sqrt(variances)).sum()


def best(function):
    return minimize_scalar(function, bounds=(1e-3, 1), method='bounded', options={'xatol': 1e-6}).x


greatest, least = best(lambda noise: -filtered(noise)['loglike']), best(lambda noise: filtered(noise)['loglike'])
expected = best(lambda noise: -right(noise))
print('deviation', READINGS.std(), 'greatest', greatest, 'least', least, 'right', expected)
assert abs(expected / READINGS.std() - 1) < 0.01
assert greatest > 0.99
assert abs(least * np.sqrt(2) / READINGS.std() - 1) < 0.01
PYTHON

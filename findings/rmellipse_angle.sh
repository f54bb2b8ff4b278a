#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rmellipse 0.5.0: an angle of 180 ± 0.57 degrees is ± 179 degrees by its Monte Carlo samples, and the mean of 25
# readings is as uncertain as one reading.
#
# This package of NIST propagates uncertainties as the GUM says. First, a shaft's angle is found from the sine and
# cosine of its encoder, each ± 0.01. stdunc(deg=True) is documented to support angles, and gives the linear and the
# Monte Carlo uncertainty. Expected: ± 0.57 degrees by both, wherever the shaft is. What happens: so it is at 0 and 90
# degrees, but at 180 degrees, where the samples wrap, it is ± 0.57 and ± 179. Only the linear one heeds deg=True.
# Second, combine(..., error_of_mean=True) is to give the error of the mean of repeated readings. Of 25 readings with a
# standard deviation of 0.084 it should be 0.017. So it is for readings without a dimension and for arrays of two. For
# arrays of one value it is 0.084: error_of_mean has no effect there. The code in 0.5.1, for Python 3.12, is the same.
# For us: take only the linear uncertainty of an angle, and combine readings without a dimension.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check rmellipse==0.5.0 numpy==2.4.6 pyyaml==6.0.3
cd "$folder"
timeout 120 venv/bin/python -W ignore - <<'PYTHON'
import numpy as np
import xarray as xr
from rmellipse.propagators import RMEProp
from rmellipse.uobjects import RMEMeas

np.random.seed(0)
both = RMEProp(sensitivity=True, montecarlo_sims=2000)


@both.propagate
def angle(sine, cosine):
    return np.degrees(np.arctan2(sine, cosine))


def uncertainties(degrees):
    """The linear and the Monte Carlo uncertainty of a shaft's angle in degrees."""
    turned = np.radians(degrees)
    signals = [RMEMeas.from_dist(name, value, 0.01, samples=2000)
               for name, value in (('sine', np.sin(turned)), ('cosine', np.cos(turned)))]  # fmt: skip
    return [float(value) for value in angle(*signals).stdunc(deg=True)]


for degrees in (0.0, 90.0, 180.0):
    linear, sampled = uncertainties(degrees)
    print(degrees, 'degrees: linear', linear, 'Monte Carlo', sampled)
    assert abs(linear - 0.573) < 0.001
    assert 178 < sampled < 180 if degrees == 180.0 else abs(sampled - 0.573) < 0.03

READINGS = np.random.default_rng(1).normal(10.0, 0.1, 25)


def mean_uncertainty(array, error_of_mean):
    """The uncertainty of the first value of the mean of 25 readings, each in the shape that `array` gives it."""
    readings = [RMEMeas.from_nom(f'reading {index}', array(value)) for index, value in enumerate(READINGS)]
    combined = RMEProp(sensitivity=True).combine(*readings, error_of_mean=error_of_mean)
    return round(float(np.ravel(combined.stdunc()[0].values)[0]), 4)


shapes = {
    'no dimension': xr.DataArray,
    'one value': lambda value: xr.DataArray([value], dims='x', coords={'x': [0]}),
    'two values': lambda value: xr.DataArray([value, 2 * value], dims='x', coords={'x': [0, 1]}),
}
found = {name: [mean_uncertainty(array, choice) for choice in (False, True)] for name, array in shapes.items()}
print('one reading, and the mean:', found)
assert found == {'no dimension': [0.0837, 0.0167], 'one value': [0.0837, 0.0837], 'two values': [0.0837, 0.0167]}
PYTHON

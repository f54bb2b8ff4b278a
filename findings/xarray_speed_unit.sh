#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# xarray 2026.9.0: a shaft at 2 rad/s has a speed of 2, 0.002, 2e-6 or 2e-9, depending on the unit of its stamps.
#
# The angle of a shaft is kept with its stamps, which are equal instants in s, ms, µs or ns. Expected of
# differentiate('time'): the same speed of all four, or an error, as no unit is asked for. What happens: it is per unit
# in which the stamps happen to be kept, which depends on the file and on the version of pandas: ns by pandas 2, µs by
# pandas 3, so that a threshold or a plot changes by 1000. integrate() of a speed of 2 rad/s over 10 s is 20, 20 000,
# 2e7 or 2e10 rad likewise. polyfit() gives the slope per ns for all four. With datetime_unit='s' the speed of all four
# is 2 rad/s.
# For us: always give datetime_unit='s', and divide the slope of polyfit() by 1e-9.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check xarray==2026.9.0 pandas==3.1.1 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
import pandas as pd
import xarray as xr

seconds = np.arange(11)
default = pd.to_datetime(pd.Series(1_767_225_600 + seconds), unit='s').dt.unit
print('Unit of stamps by pandas', pd.__version__, default)
found = {}
for unit in ('s', 'ms', 'us', 'ns'):
    stamps = (np.datetime64('2026-01-01', 's') + seconds).astype(f'datetime64[{unit}]')
    angle = xr.DataArray(2.0 * seconds, dims='time', coords={'time': stamps})
    assert angle.time.dtype == stamps.dtype
    speed, known = angle.differentiate('time'), angle.differentiate('time', datetime_unit='s')
    turned = xr.full_like(angle, 2.0).integrate('time')
    slope = angle.polyfit('time', 1).polyfit_coefficients.sel(degree=1)
    found[unit] = [f'{float(value):.3g}' for value in (speed.mean(), turned, slope, known.mean())]
    print('Speed, turned by, slope, speed by datetime_unit="s" of stamps in', unit, found[unit])
assert default == 'us'
assert found == {
    's': ['2', '20', '2e-09', '2'],
    'ms': ['0.002', '2e+04', '2e-09', '2'],
    'us': ['2e-06', '2e+07', '2e-09', '2'],
    'ns': ['2e-09', '2e+10', '2e-09', '2'],
}
PYTHON

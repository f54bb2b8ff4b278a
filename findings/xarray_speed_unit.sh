#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# xarray 2026.9.0: a shaft at 2 rad/s has a speed of 2, 0.002, 2e-6 or 2e-9, depending on the unit of its stamps.
#
# The angle of a shaft is kept with its stamps, which are equal instants in s, ms, µs or ns. Expected of
# differentiate('time'): the same speed of all four, or an error, as no unit is asked for. What happens: it is per unit
# in which the stamps happen to be kept. pandas 3.1.1 makes them in µs, also of seconds. integrate() of a speed of 2
# rad/s over 10 s is 20, 20 000, 2e7 or 2e10 rad likewise. polyfit() gives the slope per ns for all four. With
# datetime_unit='s' the speed of all four is 2 rad/s, and the angle by integrate() 20 rad.
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
    turned, sure = (xr.full_like(angle, 2.0).integrate('time', unit) for unit in (None, 's'))
    slope = angle.polyfit('time', 1).polyfit_coefficients.sel(degree=1)
    found[unit] = [f'{float(value):.3g}' for value in (speed.mean(), turned, slope, known.mean(), sure)]
    print(unit, 'speed, turned by, slope, and speed and turned by with datetime_unit="s":', found[unit])
assert default == 'us'
assert found == {
    's': ['2', '20', '2e-09', '2', '20'],
    'ms': ['0.002', '2e+04', '2e-09', '2', '20'],
    'us': ['2e-06', '2e+07', '2e-09', '2', '20'],
    'ns': ['2e-09', '2e+10', '2e-09', '2', '20'],
}
PYTHON

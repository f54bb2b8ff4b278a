#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pandas 3.1.1, polars 2.1.0: a record of 10 240 Hz, by its mean interval, has 10 309 Hz, and by pandas no jitter.
#
# Ten seconds of stamps in µs, as a bench writes them. Expected of the mean of diff(): 97.66 µs. What happens: a mean, a
# standard deviation and a quotient of durations are cut off to the unit of the stamps: 97 µs. This unit is µs in pandas
# 3.1.1, also for stamps in ms or as text; with stamps in ns the same lines give 10 240.0 Hz. So a gear mesh at 1000 Hz
# is put at 1007 Hz, a grid of times that is built from the first stamp and the mean interval ends 67 ms too early, and
# the standard deviation of the intervals is 0 instead of 0.47 µs. polars and NumPy cut a mean off too.
# For us: make numbers first: diff().dt.total_seconds().mean(), or divide the whole span in seconds by its intervals.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pandas==3.1.1 numpy==2.4.6 polars==2.1.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
import pandas as pd
import polars as pl

RATE, SECOND = 10240, pd.Timedelta(seconds=1)
micros = 1_767_225_600_000_000 + np.round(np.arange(10 * RATE) * 1e6 / RATE).astype(np.int64)
stamps = pd.Series(pd.to_datetime(micros, unit='us'))
assert stamps.dtype == pd.to_datetime(pd.Series([1, 2]), unit='ms').dtype == 'datetime64[us]'
assert pd.to_datetime(pd.Series(['2026-01-01 00:00:00.000098'])).dtype == 'datetime64[us]'


def measured(stamps):
    intervals, span = stamps.diff(), stamps.iloc[-1] - stamps.iloc[0]
    interval = intervals.mean()
    end = stamps.iloc[0] + interval * (len(stamps) - 1)
    return {
        'rate': round(float(SECOND / interval), 1),
        'rate by the span': round(float(SECOND / (span / (len(stamps) - 1))), 1),
        'end of a grid in ms': round(float((end - stamps.iloc[-1]) / SECOND) * 1e3),
        'jitter in us': round(float(intervals.std() / SECOND) * 1e6, 2),
        'rate by numbers': round(float(1 / intervals.dt.total_seconds().mean()), 1),
    }


by_micros, by_nanos = measured(stamps), measured(stamps.dt.as_unit('ns'))
print('Stamps in µs:', by_micros, 'the same stamps in ns:', by_nanos)
assert list(by_micros.values()) == [10309.3, 10309.3, -67, 0.0, 10240.0]
assert list(by_nanos.values()) == [10240.0, 10240.0, 0, 0.47, 10240.0]
others = pl.Series(micros).cast(pl.Datetime('us')).diff().mean(), np.diff(stamps.to_numpy()).mean().item()
print('Mean interval by polars and by NumPy:', *others)
assert all(value.total_seconds() == 97e-6 for value in others)
PYTHON

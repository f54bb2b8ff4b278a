#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# downsampler 0.4.2: a record of 1 kHz in steps of 2.5 ms loses every other mean, and times go back after a gap.
#
# A shaft recorded each millisecond. Expected of means in steps of 2.5 ms: 800 in 2 s. What happens: a step holds two
# or three samples in turn, and two are less than the 90 % of 2.5 that a mean needs, so that 400 are NaN, without a
# warning; in steps of 2 or 10 ms none is. Where 50 samples are missing, LTTB and M4 put a row of NaN 0.1 s behind the
# last sample, as for records of minutes. That is 49 ms after the record goes on: the times of the result, 1.099 s and
# then 1.050 s, do not rise, and the row is drawn as a break where there is none.
# For us: use steps of whole samples, or min_completeness=0.5; after LTTB or M4 drop the rows of NaN.
#
# Exit code 0: still so. Its lttbc is compiled here, as its wheel is for numpy 1. Needs a C compiler.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-binary lttbc \
    downsampler==0.4.2 lttbc==0.3.0 pandas==3.1.1 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import pandas as pd
from downsampler import downsample_dataframe


def record(milliseconds):
    times = pd.to_datetime(milliseconds, unit='ms')
    return pd.DataFrame({'position': [0.01 * time for time in milliseconds]}, index=times)


missing = {}
for step in ('2ms', '2500us', '10ms'):
    means = downsample_dataframe(record(list(range(2000))), step)
    missing[step] = int(means.position.isna().sum()), len(means)
print('means that are NaN, of all', missing)
assert missing == {'2ms': (0, 1000), '2500us': (400, 800), '10ms': (0, 200)}

interrupted = record([*range(1000), *range(1050, 2000)])
for method in ('lttb', 'm4'):
    fewer = downsample_dataframe(interrupted, '20ms', method=method, lttb_target_column='position')
    [row] = [number for number, value in enumerate(fewer.position) if value != value]
    print(method, fewer.index[row - 1 : row + 2].strftime('%S.%f').tolist(), fewer.position.iloc[row - 1 : row + 2].tolist())
    assert not fewer.index.is_monotonic_increasing
    assert fewer.index[row] == pd.Timestamp(1099, unit='ms') and fewer.index[row + 1] == pd.Timestamp(1050, unit='ms')
PYTHON

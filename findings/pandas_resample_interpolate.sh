#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pandas 3.1.1: resample().interpolate() places an evenly moving joint up to a third of a sample off.
#
# A joint turns by 1 rad/s and is recorded every 100 ms. resample('75ms').interpolate() gives 0.050 rad at 75 ms, and 0.250
# at 225 ms, where 0.075 and 0.225 are right. It interpolates over the rows of both times together, as if they were evenly
# spaced: between 0 and 100 ms the one new row is in the middle. At 50 ms it is right by chance.
# interpolate(method='time') gives the right angles.
# For us: transmission errors from tables that were resampled so are those of the table; gearkin takes the original.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pandas==3.1.1
"$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
import pandas

times = pandas.to_timedelta(np.arange(4) * 100, unit='ms')
angle = pandas.Series([0.0, 0.1, 0.2, 0.3], index=times)
for step, options, expected in (
    ('75ms', {}, [0.0, 0.05, 0.15, 0.25, 0.3]),
    ('75ms', {'method': 'time'}, [0.0, 0.075, 0.15, 0.225, 0.3]),
    ('50ms', {}, [0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3]),
):
    resampled = angle.resample(step).interpolate(**options)
    print(step, options, resampled.round(6).tolist())
    assert np.allclose(resampled, expected)
PYTHON

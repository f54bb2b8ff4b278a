#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# polars 2.1.0: upsample() drops the samples off its grid, and interpolate() then bridges them.
#
# A joint is recorded every 100 ms: 0, 1, 0 and 0.3 rad. upsample every 75 ms, with interpolate as its documentation
# shows, gives 0, 0.075, 0.15, 0.225 and 0.3 rad: of the samples only those at 0 and 300 ms are used, and the motion to
# 1 rad is gone. Every 50 ms all samples are on the grid, and the motion is there. Expected: values interpolated between
# the nearest samples, as numpy.interp does: 0.75 rad at 75 ms.
# For us: do not bring rotor and output to a common time this way before gearkin; it interpolates itself.
#
# Exit code 0: still so. Installs the packages into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check polars==2.1.0 numpy==2.4.6
"$folder/venv/bin/python" - <<'PYTHON'
from datetime import datetime, timedelta

import numpy as np
import polars

measured = [0.0, 1.0, 0.0, 0.3]
times = [datetime(2026, 1, 1) + timedelta(milliseconds=100 * number) for number in range(4)]
table = polars.DataFrame({'time': times, 'angle': measured})
for step, expected in (('75ms', [0, 0.075, 0.15, 0.225, 0.3]), ('50ms', [0, 0.5, 1, 0.5, 0, 0.15, 0.3])):
    angles = table.upsample('time', every=step).with_columns(polars.col('angle').interpolate())['angle']
    print(step, angles.to_list())
    assert np.allclose(angles, expected)
right = np.interp(np.arange(5) * 75.0, np.arange(4) * 100.0, measured)
print('numpy.interp', right)
assert right[1] == 0.75
PYTHON

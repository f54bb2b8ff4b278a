#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# derivative 0.6.3: a finite difference is given all times, but divides by the first step alone, so that a jitter scales all speeds.
#
# A shaft turns at 2 rad/s and is sampled every 10 ms; only the second sample is 2 ms early. Expected of dxdt(x, t,
# kind='finite_difference', k=1): 2 rad/s everywhere, as numpy.gradient(x, t) gives. What happens: 2.5 rad/s, for all of the
# recording, as t[1] - t[0] is 8 ms. No warning tells of it; the method's docstring says that it is for equally spaced data. The
# kinds savitzky_golay, spline and kalman take each time as it is.
# For us: the stamps of a recording always jitter; resample first, or take one of these kinds.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check derivative==0.6.3 numpy==2.4.6
timeout 100 "$folder/venv/bin/python" - <<'PYTHON'
import warnings

import numpy as np
from derivative import dxdt

times = np.arange(500) * 0.01
times[1] -= 0.002
angle = 2 * times
with warnings.catch_warnings():
    warnings.simplefilter('error')
    speed = dxdt(angle, times, kind='finite_difference', k=1)
print('finite difference', np.median(speed), 'rad/s, in the last second', speed[-100:].min(), 'to', speed[-100:].max())
assert abs(np.median(speed) - 2.5) < 1e-9 and abs(speed[-100:] - 2.5).max() < 1e-9
assert abs(np.gradient(angle, times) - 2).max() < 1e-9
for kind, options in [('savitzky_golay', {'left': 0.05, 'right': 0.05, 'order': 2}), ('spline', {'s': 1e-6})]:
    speed = dxdt(angle, times, kind=kind, **options)
    print(kind, speed.min(), 'to', speed.max(), 'rad/s')
    assert abs(speed - 2).max() < 1e-6
PYTHON

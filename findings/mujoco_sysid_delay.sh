#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# MuJoCo 4.0.0: apply_delay() of its system identification changes the record that it is given, by 10 ms with each call.
#
# A record of an output at 2 rad/s is to be shown with a delay of 10 ms. Expected: a delayed copy, as apply_bias() and
# apply_gain() make one. What happens: the delay is written into the record itself as well, so that a second call, as
# for each step of a fit or for each delay of a list, gives a delay of 20 ms, a third 30 ms.
# normalize_residual(), which model_residual() applies to each sensor, is to divide "by the standard deviation of the
# measured data", and divides by the root of half the sum of squares instead. The same error of an output that swings by
# 0.1 rad therefore counts 1400 times less about 100 rad than about 0, and half as much in a record four times as long.
# For us: give apply_delay() a copy, and take the mean away from angles before they are fitted together.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mujoco==4.0.0 numpy==2.4.6 scipy==1.17.1 \
    absl-py==2.5.1 colorama==0.4.6 ImageIO==2.38.1 Jinja2==3.1.6 matplotlib==3.11.2 plotly==7.1.0 PyYAML==6.0.4 \
    tabulate==0.10.0 typing_extensions==4.16.0
MPLBACKEND=Agg timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from mujoco import sysid

times = np.arange(0, 2, 0.001)
record = sysid.TimeSeries.from_custom_map(times, 2 * times[:, np.newaxis], ['output'])
delay = sysid.Parameter('delay', 0.01, 0, 0.1)
found = []
for _ in range(3):
    delayed = sysid.apply_delay(record, 'output', delay)
    found.append(1 - float(delayed.data[1000, 0]) / 2)
print('delays of three calls', found, 's; record at 1 s', record.data[1000, 0], 'rad')
assert np.allclose(found, (0.01, 0.02, 0.03)) and abs(record.data[1000, 0] - 2 * 0.97) < 1e-9

one = sysid.Parameter('one', 1, 0, 2)
before = record.data.copy()
assert sysid.apply_bias(record, 'output', one).data[1000] != before[1000] and np.array_equal(record.data, before)
assert sysid.apply_gain(record, 'output', sysid.Parameter('half', 0.5, 0, 1)).data[1000] != before[1000]
assert np.array_equal(record.data, before)


def counted(middle, samples=2000):
    """Return the normalized residual of an error of 1 mrad, and the one by the standard deviation."""
    swing = middle + 0.1 * np.sin(2 * np.pi * 0.05 * np.arange(samples))[:, np.newaxis]
    residual = float(sysid.normalize_residual(np.full_like(swing, 0.001), swing)[0, 0])
    print('about', middle, 'rad,', samples, 'samples: normalized', residual, 'by the deviation', 0.001 / swing.std())
    assert abs(0.001 / swing.std() - 0.01414) < 1e-4
    return residual


about_0 = counted(0)
assert abs(about_0 / counted(100) - 1414) < 2 and abs(about_0 / counted(0, 8000) - 2) < 0.01
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# python-control 0.10.2: step_info() of a measured response takes it to begin at 0.
#
# An output goes from 5 to 6 with a time constant of 1 s: it rises from 10 to 90 % in 2.20 s, and is within 2 % after
# 3.91 s. step_info(angle, T=time) says 0.52 s and 2.12 s, as if the step were from 0 to 6; of an output that goes from
# 1005 to 1006 both are 0. It has an argument for the final value, but none for the initial one.
# For us: subtract the first value from an output angle before the call.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check control==0.10.2
"$folder/venv/bin/python" - <<'PYTHON'
import control
import numpy as np

time = np.linspace(0.0, 20.0, 2001)
rise = 1.0 - np.exp(-time)
for start, expected in ((0.0, (2.20, 3.91)), (5.0, (0.52, 2.12)), (1005.0, (0.0, 0.0))):
    info = control.step_info(start + rise, T=time)
    found = info['RiseTime'], info['SettlingTime']
    print(f'from {start}: rise time {found[0]:.2f} s, settling time {found[1]:.2f} s')
    assert np.allclose(found, expected, atol=0.02)
PYTHON

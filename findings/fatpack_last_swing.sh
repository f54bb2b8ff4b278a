#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# fatpack 0.7.8: the greatest swing of a torque is not among its rainflow ranges if the record ends there.
#
# Expected: the ranges of -5, -2, -6, 3, -8 N·m hold the swing of 11 N·m from 3 to -8, as rainflow 3.2.0 (ASTM E1049)
# counts it, half. What happens: the greatest range is 8.94. Ranges come from closed loops alone: what is left is
# appended to itself, and the join takes the first and last extreme away where they lie in one direction. With a return
# to 0 as last sample it is 11.0. All values are put into 64 classes first, so that a swing of 7 N·m is 7.03.
# For us: the loads of an actuator end where the recording ends; append the first value before you count.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check fatpack==0.7.8 rainflow==3.2.0 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import fatpack
import numpy as np
import rainflow

torque = np.array([-5.0, -2.0, -6.0, 3.0, -8.0])
ranges = fatpack.find_rainflow_ranges(torque)
counted = [range_ for range_, _ in rainflow.count_cycles(torque)]
returned = fatpack.find_rainflow_ranges(np.append(torque, 0.0))
closed = fatpack.find_rainflow_ranges(np.append(torque, torque[0]))
print('fatpack', ranges, 'rainflow', counted, 'after a return to 0', returned, 'to the first value', closed)
assert abs(ranges.max() - 8.94) < 0.01 and max(counted) == 11.0
assert abs(returned.max() - 11.0) < 0.01 and abs(closed.max() - 11.0) < 0.01
assert fatpack.find_rainflow_ranges(np.array([0.0, 5.0, -3.0, 4.0, -4.0, 6.0, 0.0]))[0] == 7.03125
PYTHON

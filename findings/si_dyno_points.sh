#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# si-dyno-reader 0.0.5: a measuring point at 100 N·m has a mean of 80 N·m, and a torque that is missing is -1 N·m.
#
# A file of a test bench in the format of its README, with a measuring point of four samples at 100 N·m, marked by
# Test_State, after which the load is taken off. Expected of get_measure_point("Torque"): 100. What happens: the first
# sample after the point, which is below the threshold, is taken as part of it, so that the mean is 80 and the least
# value 0. Expected of an empty cell, where the torque sensor gave nothing: NaN, or an error. What happens: it is -1,
# as is a text and a number with a decimal comma, and it counts in the mean, the minimum and the maximum, without a
# warning; the mean of 100, 100, a missing one and 100 is 74.75.
# For us: read such a file with pandas, where an empty cell is NaN, and select the rows of a point by Test_State.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check si-dyno-reader==0.0.5 numpy==2.4.6
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
from si_dyno_reader import DynoDataSet, MetricType


def read(torques, states):
    rows = [f'{0.5 * row}\t{torque}\t{state}' for row, (torque, state) in enumerate(zip(torques, states, strict=True))]
    with open('bench-00001.001', 'w') as file:
        file.write('\n'.join(['Time\tTorque\tTest_State', 's\tNm\t-', *rows]) + '\n')
    return DynoDataSet('bench-00001.001')


data = read(['0', '50', '100', '100', '100', '100', '0', '0'], [0, 0, 100, 100, 100, 100, 0, 0])
mean, least = (data.get_measure_point('Torque', metric)[0] for metric in (MetricType.MEAN, MetricType.MIN))
print('point', data.get_measure_point_data('Torque'), 'mean', mean, 'least', least)
assert (mean, least) == (80.0, 0.0)
assert data.get_measure_point('Test_State', MetricType.MIN) == [0.0]

data = read(['100', '100', '', '100'], [0] * 4)
print('with a missing torque', data.get_data('Torque'), 'mean', data.get_data('Torque', MetricType.MEAN))
assert data.get_data('Torque') == [100.0, 100.0, -1, 100.0]
assert data.get_data('Torque', MetricType.MEAN) == 74.75
assert read(['0,5', '1,5'], [0, 0]).get_data('Torque') == [-1, -1]
PYTHON

#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# newportxps 2026.1.1: a stage that is to turn evenly through 11 points stops 13 times; 500°/s pass at a limit of 20°/s.
#
# An array trajectory has points of an axis at even times; the file for the XPS has the time, the way and the speed at
# the end of each segment. A stage is to turn from 0° to 10° by 1° each 0.1 s. Expected: speeds of 10°/s, as
# define_line_trajectories() of this library writes them for the same scan, and 0 at the end. What happens: all speeds
# are 0, as they are made of the differences of the ways and not of the ways: by the file, a stage stops at the end of
# each of the 13 segments. For the same reason the limits do not help: 50° each 0.1 s are 500°/s, which are accepted
# with a greatest speed of 20°/s and a greatest acceleration of 80°/s², where a ValueError is to be raised.
# By the documentation each point is the middle between two ends of segments. Expected: the ends are at -0.5°, 0.5° and
# so on. What happens: they are at 0.475°, 1.475° and so on, as the first way does not begin at the start, -0.525°.
# No controller takes part here: the file is looked at which would be sent to it.
# For us: use straight scans, or write such a file yourself, if an encoder is to be measured at an even speed.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check newportxps==2026.1.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy
from newportxps import NewportXPS


class Offline(NewportXPS):
    """A controller with one rotary stage, of which only the files that are sent to it are kept."""

    def __init__(self):
        self._sid, self._xps, self.trajectories, self.sent = 1, None, {}, {}
        self.groups = {'G': {'category': 'MultipleAxesInUse', 'positioners': ['THETA']}}
        self.stages = {'G.THETA': {'max_velo': 20.0, 'max_accel': 80.0}}
        self.set_trajectory_group('G')

    def upload_trajectory(self, filename, text):
        rows = [[float(number) for number in line.split(',')] for line in text.split('\n') if line]
        self.sent[filename] = numpy.array(rows)


xps = Offline()
xps.define_line_trajectories('THETA', start=0, stop=10, step=1, pixeltime=0.1)
print('straight scan: time, way and speed\n', xps.sent['foreward.trj'])
assert xps.sent['foreward.trj'][:, 2].tolist() == [10, 10, 0]

made = xps.define_array_trajectory({'THETA': numpy.arange(11.0)}, dtime=0.1)
times, ways, speeds = xps.sent['array.trj'].T
ends = made['start']['THETA'] + numpy.cumsum(ways)
print('array: times', times, 'ways', ways, 'speeds', speeds)
print('start', made['start']['THETA'], 'ends of the segments', ends)
assert numpy.all(times == 0.1) and numpy.all(ways == 1) and numpy.all(speeds == 0) and len(ways) == 13
assert abs(made['start']['THETA'] + 0.525) < 1e-9 and numpy.allclose(ends, numpy.arange(13) + 0.475)

xps.define_array_trajectory({'THETA': 50 * numpy.arange(11.0)}, dtime=0.1, name='fast')
times, ways, speeds = xps.sent['fast.trj'].T
print('fast: speed', ways / times, 'speeds in the file', speeds)
assert numpy.all(ways / times == 500) and numpy.all(speeds == 0) and xps.trajectories['fast']['uploaded']
PYTHON

#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# robotkinematicscatalogue 1.1.2: half way of its move from 80° to 100°, a joint is sent to 0°, as every other joint is.
#
# parabolicBlendPoint() gives the joints at a time of a move with parabolic blends. Two joints move within 2 s, from 80°
# to 100° and from 0° to 50°, sampled each 10 ms. Expected at 1 s, half way, by symmetry: 90° and 25°. What happens: 0°
# and 0°, without an error; the samples before and after are right. Without a given acceleration the blends meet in the
# middle, and the function has a case for the times before it and one for those behind it, but none for the middle.
# For us: sample a trajectory, and compare the greatest step of each joint with its limit of speed before it is sent.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check robotkinematicscatalogue==1.1.2
cd "$folder"
venv/bin/python - <<'PYTHON'
import contextlib
import io

import numpy
from robotkinematicscatalogue.trajectoryGeneration import trajectoryGeneration

start, goal, duration = numpy.array([80.0, 0.0]), numpy.array([100.0, 50.0]), 2.0
times = [sample / 100 for sample in range(201)]
with contextlib.redirect_stdout(io.StringIO()):
    found = numpy.array([trajectoryGeneration.parabolicBlendPoint(start, goal, duration, time) for time in times])
expected = []
for time in times:
    part = 2 * (time / duration) ** 2 if time < duration / 2 else 1 - 2 * (1 - time / duration) ** 2
    expected.append(start + part * (goal - start))
wrong = numpy.flatnonzero(numpy.abs(found - expected).max(axis=1) > 1e-9)
for sample in range(99, 102):
    print(f'{times[sample]} s: expected {expected[sample].round(3)}, found {found[sample].round(3)}')
assert wrong.tolist() == [100] and found[100].tolist() == [0.0, 0.0]
PYTHON

#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mistgen 0.2.6: after a first path of 10 s, a path that is to take 2 s takes 10 s as well, at a fifth of its speed.
#
# One generator plans two paths of two joints. The duration T is an argument of mist_2d_gen(). Expected of the second
# path with T=2: it ends at 2 s, and its middle point, which is halfway of its length, is passed at 1 s. What happens:
# it ends at 10 s, and passes its middle point after a tenth of this time, where the middle point of the first path lay:
# the times of the points are kept in the generator by the first call and never computed again. A new generator gives
# 2 s and 1 s.
# For us: make a new generator for each path, and compare the last time with the duration that was asked for.
#
# Exit code 0: still so. Installs the versions into a temporary folder (matplotlib is newer than the 3.4.2 asked for).
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
pip() { "$folder/venv/bin/pip" install --quiet --disable-pip-version-check "$@"; }
pip numpy==2.2.6 scipy==1.15.3 cvxopt==1.3.2 matplotlib==3.10.3
pip --no-deps mistgen==0.2.6
cd "$folder"
MPLBACKEND=Agg venv/bin/python - <<'PYTHON'
import contextlib
import io

import numpy
from mistgen.mist import mist_generator

rest = numpy.zeros(2)
first = numpy.array([[0.0, 0.1, 1.0], [0.0, 0.0, 0.0]])
second = numpy.array([[0.0, 0.5, 1.0], [0.0, 0.0, 0.0]])


def plan(generator, points, duration):
    """The last time of the path in s, and the time at which the first joint passes the middle point."""
    with contextlib.redirect_stdout(io.StringIO()):
        joint, _, times = generator.mist_2d_gen(points, rest, rest, rest, rest, T=duration)
    return round(float(times[-1]), 1), round(float(times[numpy.argmin(numpy.abs(joint - points[0, 1]))]), 1)


used = mist_generator()
print('first path', plan(used, first, 10))
found, right = plan(used, second, 2), plan(mist_generator(), second, 2)
print('second path: the same generator', found, 'a new one', right)
assert right == (2.0, 1.0) and found == (10.0, 1.0)
PYTHON

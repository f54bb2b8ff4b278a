#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# two-point-interpolation 1.3.2: a slow move of limited jerk jumps by 146 mrad at its end, and a joint that moves already is at rest.
#
# TwoPointInterpolationJerk is to go from 0 to 10 rad with at most 1 rad/s², 1 rad/s³ and 0.5 rad/s. At this speed the greatest
# acceleration is never reached: the jerk must change after sqrt(0.5) s, at 0.71 rad/s². What happens: the acceleration goes up to
# 1 rad/s²; after 1 s the position goes back by 21 mrad and the speed by 0.125 rad/s, and 1 s before the end the position jumps
# by 146 mrad to its goal. It is so for each long move whose greatest speed is below a²/j; at 2 rad/s all is smooth.
# A joint that already turns at v0 = 1 rad/s is to begin at 0 rad/s: v0 and ve are taken, but not used. TwoPointInterpolation of
# the same package, with limited acceleration, uses them.
# For us: give an acceleration of at most sqrt(j v), and stop before a move.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check two-point-interpolation==1.3.2 numpy==2.4.6
cd "$folder"
timeout 100 "$folder/venv/bin/python" - <<'PYTHON'
import contextlib
import io
import math

import numpy as np
from two_point_interpolation import TwoPointInterpolationAcc, TwoPointInterpolationJerk

STEP = 1e-4


def planned(vmax, amax=1.0, **start):
    """The greatest steps of position back and on, the greatest steps of speed, and the greatest acceleration."""
    move = TwoPointInterpolationJerk()
    with contextlib.redirect_stdout(io.StringIO()):
        move.init(p0=0.0, pe=10.0, amax=amax, vmax=vmax, jmax=1.0, **start)
        end = move.calc_trajectory()
    points = [move.get_point(t)[:3] for t in np.arange(0.0, end, STEP)]
    positions, speeds, accelerations = np.array([*points, (10.0, 0.0, 0.0)]).T
    found = np.diff(positions).min(), np.diff(positions).max(), np.abs(np.diff(speeds)).max(), np.abs(accelerations).max()
    print(f'at most {vmax} rad/s, {amax:.2f} rad/s²: steps of position, of speed, acceleration', [float(round(value, 4)) for value in found])
    return found, speeds[0]


slow = planned(0.5)[0]
assert abs(slow[0] + 0.0208) < 0.001 and abs(slow[1] - 0.1461) < 0.001 and slow[2] > 0.37 and slow[3] > 0.999
for smooth in (planned(2.0)[0], planned(0.5, amax=math.sqrt(0.5))[0]):
    assert smooth[0] >= 0 and smooth[1] < 2.1 * STEP and smooth[2] < 2 * STEP
assert planned(2.0, v0=1.0)[1] == 0.0
limited = TwoPointInterpolationAcc()
limited.init(p0=0.0, pe=10.0, acc_max=1.0, vmax=2.0, v0=1.0)
limited.calc_trajectory()
assert limited.get_point(0.0)[1] == 1.0
PYTHON

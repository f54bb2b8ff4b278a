#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# roboticstoolbox-python 1.5.0: mstraj() with a greatest speed of 1 rad/s turns a joint at 1.5 rad/s just before it
# stops.
#
# A joint goes from 0 to 10 rad with qdmax=1, "maximum speed", and an acceleration time of 0.2 s. Expected: no more than
# 1 rad/s. What happens: it cruises at 0.99 rad/s, and has 1.497 rad/s 60 ms after the start and 60 ms before the end,
# in qd and in the differences of q. Each blend at an end of the path has to cover as much way as the cruise does in its
# time, although it begins or ends at rest. So a path of 2 rad is too fast by 44 %, and one of 0.2 rad, which has no
# cruise, is not. The acceleration is 39 rad/s².
# For us: give qdmax divided by 1.52 to mstraj(), or use ruckig.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check roboticstoolbox-python==1.5.0 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from roboticstoolbox import mstraj

STEP = 0.001
for goal, cruise, fastest in (2, 0.9524, 1.44), (10, 0.9901, 1.497):
    path = mstraj(np.array([[0.0], [goal]]), dt=STEP, tacc=0.2, qdmax=1.0)
    speeds = np.diff(path.q[:, 0]) / STEP
    middle = speeds[len(speeds) // 2]
    print('to', goal, 'rad: middle', middle, 'greatest of qd', path.qd.max(), 'of q', speeds.max(), 'rad/s')
    print('  greatest speed of the first half at', path.t[speeds[: len(speeds) // 2].argmax()], 's, of all at',
          path.t[speeds.argmax()], 's of', path.t[-1], 's; acceleration', np.abs(path.qdd).max())
    assert abs(middle - cruise) < 1e-3 and abs(speeds.max() - fastest) < 2e-3 and abs(path.qd.max() - fastest) < 2e-3
    assert abs(path.q[-1, 0] - goal) < 1e-9
short = mstraj(np.array([[0.0], [0.2]]), dt=STEP, tacc=0.2, qdmax=1.0).qd.max()
slower = [mstraj(np.array([[0.0], [goal]]), dt=STEP, tacc=0.2, qdmax=1 / 1.52).qd.max() for goal in (2, 10, 100)]
print('greatest speed to 0.2 rad', short, 'to 2, 10 and 100 rad with qdmax=1/1.52', slower)
assert short < 1 and max(slower) < 1
PYTHON

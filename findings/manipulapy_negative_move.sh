#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# ManipulaPy 1.4.2: a joint that swings to 1 rad has an overshoot of 25 % and a rise time of 0.73 s, one that swings to
# -1 rad has -100 % and 0 s.
#
# The step response of a joint is evaluated, and then the same response with the other sign. Expected: the same metrics,
# as the settling time is 4.21 s for both. What happens: calculate_rise_time() looks for the first value that is not
# less than 10 % of the goal, which is the first of all at a negative goal, and calculate_percent_overshoot() takes the
# greatest value, which is then the start. A move from 1 rad back to 0 rad has no overshoot either, as each goal of 0
# has 0 %, although the joint swings through by 0.25 rad. No warning says so, and a limit of the overshoot is passed by
# each of these.
# For us: give the metrics the way from the start, times the sign of the move.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check manipulapy==1.4.2 numpy==2.4.6 scipy==1.17.1
cd "$folder"
export MPLBACKEND=Agg MANIPULAPY_QUIET=1
timeout 120 venv/bin/python - <<'PYTHON'
import math

import numpy as np
from ManipulaPy.control import ManipulatorController

DAMPING, NATURAL = 0.4, 2.0
times = np.linspace(0, 10, 1001)
rate = NATURAL * math.sqrt(1 - DAMPING**2)
decay = np.exp(-DAMPING * NATURAL * times)
swing = 1 - decay * (np.cos(rate * times) + DAMPING * NATURAL / rate * np.sin(rate * times))
controller = ManipulatorController(None)


def metrics(response, goal):
    overshoot = controller.calculate_percent_overshoot(response, goal)
    rise = controller.calculate_rise_time(times, response, goal)
    settled = controller.calculate_settling_time(times, response, goal)
    print('goal', goal, 'rad: overshoot', overshoot, '%, rise time', rise, 's, settled after', settled, 's')
    return overshoot, rise, settled


assert np.allclose(metrics(swing, 1.0), (25.38, 0.73, 4.21), atol=0.01)
assert np.allclose(metrics(-swing, -1.0), (-100, 0, 4.21), atol=0.01)
back = 1 - swing
assert abs(min(back) + 0.254) < 1e-3
assert metrics(back, 0.0)[0] == 0
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# minsnap-trajectories 0.3.0: a move of least jerk has 1.7 times the least jerk, and more, the higher the degree is.
#
# generate_trajectory() finds the polynomials of the given degree with the least jerk or snap. Expected: a higher degree
# is at least as good, because it contains the lower one. What happens in closed form, the default: the coefficients
# beyond those that the values at both ends of a piece fix are not optimized, but kept small. A joint that turns by 1
# rad in 2 s, at rest at both ends, has an integral of its jerk squared of 22.5 with degree 5, 38.2 with degree 8, as in
# the README's example, and 63.4 with degree 10 of the 5 to 15 that it recommends, where it speeds up by 2.5 instead of
# 1.44 rad/s². algorithm='constrained' has 22.5 with each degree.
# For us: give degree 5 and num_continuous_orders=3 for the least jerk, 7 and 4 for the least snap.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check minsnap-trajectories==0.3.0 numpy==2.4.6 scipy==1.17.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import warnings

import minsnap_trajectories as ms
import numpy as np

warnings.simplefilter('ignore')
DURATION, ANGLE = 2.0, 1.0
times = np.linspace(0, DURATION, 20_001)
ends = [ms.Waypoint(time=time, position=np.array([angle])) for time, angle in ((0.0, 0.0), (DURATION, ANGLE))]


def planned(degree, algorithm):
    """The integral of the jerk squared, and the greatest acceleration."""
    plan = ms.generate_trajectory(ends, degree, idx_minimized_orders=3, num_continuous_orders=3, algorithm=algorithm)
    position, _, acceleration, jerk = ms.compute_trajectory_derivatives(plan, times, 4)[:, :, 0]
    assert abs(position[0]) < 1e-6 and abs(position[-1] - ANGLE) < 1e-6
    found = float(np.trapezoid(jerk**2, times)), float(np.abs(acceleration).max())
    print(f'degree {degree}, {algorithm}: {found[0]:.2f} rad²/s⁵, at most {found[1]:.2f} rad/s²')
    return found


least = 720 * ANGLE**2 / DURATION**5
assert least == 22.5
for degree, integral, greatest in ((5, 22.5, 1.44), (8, 38.2, 2.04), (10, 63.4, 2.50)):
    found = planned(degree, 'closed-form')
    assert abs(found[0] - integral) < 0.1 and abs(found[1] - greatest) < 0.01
    best = planned(degree, 'constrained')
    assert abs(best[0] - least) < 0.1 and abs(best[1] - 1.44) < 0.01
PYTHON

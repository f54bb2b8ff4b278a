#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# scikit-kinematics 0.10.4: its Kalman filter turns an arm by 2.83 rad that has turned by 1.75 rad, without any noise.
#
# An arm turns about the vertical at 0.5 rad/s, and the readings of gyroscope, accelerometer and magnetometer are exact.
# Expected of imus.kalman(): 1.75 rad after 3.5 s, which the magnetometer alone shows. What happens: 2.83 rad; an arm
# that stops at 1.0 rad is at 1.79 rad 1.5 s later. The correction is the difference of two successive measurements, not
# of a measurement and the estimate, so no error is ever corrected. The parameter D, the noise of the process, has no
# effect.
# For us: check a filter with exact readings of a known turn. 0.12.0, which needs Python 3.12, has the same correction.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check scikit-kinematics==0.10.4 numpy==2.4.6
cd "$folder"
export MPLBACKEND=Agg
timeout 90 venv/bin/python - <<'PYTHON'
import numpy as np
from skinematics import imus

RATE, SPEED = 100, 0.5
times = np.arange(0, 4, 1 / RATE)


def estimated(speeds, **options):
    angles = np.concatenate(([0], np.cumsum(speeds)[:-1])) / RATE
    level = np.zeros(len(angles))
    gravity = np.column_stack((level, level, level + 9.81))
    north = np.column_stack((np.cos(angles), -np.sin(angles), level))
    turned = imus.kalman(RATE, gravity, np.column_stack((level, level, speeds)), north, **options)
    return np.unwrap(2 * np.arctan2(turned[:, 3], turned[:, 0])), angles


turning, right = estimated(np.full(len(times), SPEED))
quiet, _ = estimated(np.full(len(times), SPEED), D=[1e-6, 1e-6, 1e-6])
stopped, still = estimated(np.where(times < 2, SPEED, 0.0))
print('turning', turning[350], 'right', right[350], 'with another D', quiet[350])
print('stopped', stopped[350], 'right', still[350])
assert abs(right[350] - 1.75) < 1e-9 and abs(turning[350] - 2.83) < 0.02
assert np.array_equal(turning, quiet)
assert abs(still[350] - 1.0) < 1e-9 and abs(stopped[350] - 1.79) < 0.02
PYTHON

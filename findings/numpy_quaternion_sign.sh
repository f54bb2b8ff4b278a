#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# numpy-quaternion 2024.0.13: a joint that turns at 10 rad/s stands still twice a turn, where a sensor gives only
# quaternions with w ≥ 0.
#
# q and -q are the same rotation, and many sensors give the one with w ≥ 0, so that the sign changes at half a turn.
# Expected of angular_velocity(): 10 rad/s throughout. What happens: it is 0 at the two samples around each change of
# sign, and 7.5, 16 and 10.9 rad/s beside them. The mean of four readings from 3.0 to 3.3 rad is 0.008 rad, and
# as_rotation_vector() is 6.18 rad of -q of 0.1 rad.
# For us: pass recorded orientations through unflip_rotors() first; then the velocity is right to 0.0001 %.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    numpy-quaternion==2024.0.13 numpy==2.4.6 scipy==1.17.1
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import numpy as np
import quaternion

SPEED = 10.0
times = np.arange(0, 2, 0.01)
turned = quaternion.from_rotation_vector(np.outer(SPEED * times, [0, 0, 1]))
sensed = np.array([value if value.w >= 0 else -value for value in turned])
velocity = quaternion.angular_velocity(sensed, times)[:, 2]
mended = quaternion.angular_velocity(quaternion.unflip_rotors(sensed), times)[:, 2]
print('velocity', velocity[28:36].round(3), 'least', velocity.min(), 'greatest', velocity.max(), 'mended', mended.min(), mended.max())
assert abs(velocity[10] - SPEED) < 1e-4
assert abs(velocity[31]) < 1e-9 and abs(velocity[32]) < 1e-9
assert abs(velocity.max() - 16.07) < 0.01
assert np.abs(mended - SPEED).max() < 1e-4

mean = quaternion.as_rotation_vector(quaternion.mean_rotor_in_chordal_metric(sensed[30:34]))[2]
right = quaternion.as_rotation_vector(quaternion.mean_rotor_in_chordal_metric(turned[30:34]))[2]
vector = quaternion.as_rotation_vector(-quaternion.from_rotation_vector(np.array([0, 0, 0.1])))
print('mean of 3.0 to 3.3 rad', mean, 'right', right, 'vector of 0.1 rad', vector)
assert abs(mean - 0.0084) < 1e-4 and abs(right - 3.15) < 1e-9
assert abs(np.linalg.norm(vector) - (2 * np.pi - 0.1)) < 1e-9
PYTHON

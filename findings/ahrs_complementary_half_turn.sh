#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# ahrs 0.4.0: an arm that lies upside down without motion is read by the Complementary filter at about 0°, as if it lay
# level.
#
# An arm is rolled by 180°; its accelerometer has a noise of 0.02 m/s². Expected of the roll: 180° or -180°, as
# Madgwick of the same library gives at each time. What happens: 1° in the mean, and never more than 116° to either
# side. The filter averages its angle and that of the accelerometer as numbers, though the latter jumps between 180° and
# -180°. Without noise, an arm that turns past 180° at 0.5 rad/s is up to 172° wrong, and for 0.34 s by more than 10°;
# with a gain of 0.98 instead of 0.9 it is so for 1.76 s.
# For us: use Madgwick or another filter of quaternions where a joint comes near to half a turn.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check ahrs==0.4.0 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from ahrs import Quaternion
from ahrs.filters import Complementary, Madgwick

RATE = 100.0


def rolls(method, roll, noise, **parameters):
    """The roll in degrees by a filter, of an IMU whose roll in rad is given at each time."""
    random = np.random.default_rng(0)
    rates = np.zeros((len(roll), 3))
    rates[1:, 0] = np.diff(roll) * RATE
    gravity = 9.81 * np.column_stack((np.zeros(len(roll)), np.sin(roll), np.cos(roll)))
    measured = gravity + random.normal(0, noise, gravity.shape)
    found = method(gyr=rates, acc=measured, frequency=RATE, **parameters).Q
    return np.degrees([Quaternion(attitude).to_angles()[0] for attitude in found])


def errors(found, roll):
    return np.abs((found - np.degrees(roll) + 180) % 360 - 180)


still, turning = np.full(1000, np.pi), np.arange(0, 5, 0.5 / RATE)
upside_down = rolls(Complementary, still, 0.02)[50:]
greatest = np.abs(upside_down).max()
print('still at 180°:', upside_down[::100].round(1), 'mean', upside_down.mean(), 'greatest', greatest)
assert abs(upside_down.mean()) < 3 and abs(greatest - 116) < 2
by_madgwick = errors(rolls(Madgwick, still, 0.02), still).max()
print('Madgwick: greatest error', by_madgwick)
assert by_madgwick < 1
for gain, wrong in (0.9, 34), (0.98, 176):
    error = errors(rolls(Complementary, turning, 0, gain=gain), turning)
    far = np.sum(error > 10)
    print('past 180° with a gain of', gain, 'greatest error', error.max(), 'over 10° for', far / RATE, 's')
    assert error.max() > 170 and abs(far - wrong) < 3
assert errors(rolls(Madgwick, turning, 0), turning).max() < 1
PYTHON

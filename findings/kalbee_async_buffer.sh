#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# kalbee 1.0.0: a shaft that turns at 1 rad/s is estimated at -2.1 rad/s after 10 s, and with two encoders at 0.5 rad/s.
#
# AsyncSensorBuffer takes measurements that come late or at several rates, around a filter "(e.g. KalmanFilter)". A
# shaft starts at a known angle of 0 and turns at 1 rad/s; an ideal encoder is read at 100 Hz. Expected at any time: 1
# rad/s. What happens: it is right for 50 readings, its default capacity. From then on the oldest reading is dropped,
# but each new one still starts from the first state, as if the shaft had been at 0 just before the 50 readings: 0.83
# rad/s after 1 s, 0.50 after 2 s and -2.14 after 10 s, with an uncertainty of 0.04. Where a second encoder is read at
# the same times, the filter is advanced twice for each of them, and the speed is 0.5 rad/s; where one is read at 50 Hz,
# KalmanFilter advances by the matrix for 10 ms all the same, and the speed is 2 rad/s, although the buffer gives it the
# time.
# For us: call predict(F=...) of the filter with the matrix for the time since the last reading, without this buffer.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check kalbee==1.0.0 numpy==2.4.6 scipy==1.17.1
cd "$folder"
timeout 200 venv/bin/python - <<'PYTHON'
import numpy as np
from kalbee import AsyncSensorBuffer, KalmanFilter
from kalbee.models.motion import constant_velocity

STEP = 0.01
transition, process = constant_velocity(STEP, 1.0)
start, covariance = np.zeros((2, 1)), np.diag([1e-8, 1.0])


def speed(times, **options):
    kalman = KalmanFilter(start, covariance, transition, process, np.array([[1.0, 0.0]]), np.array([[1e-4]]))
    buffer = AsyncSensorBuffer(kalman, dt_default=STEP, **options)
    buffer.initialize(0.0, start, covariance)
    for time in times:
        state, uncertainty = buffer.add_measurement(time, np.array([[1.0 * time]]))
    print(f'after {times[-1]:g} s: {state[1, 0]:.3f} ± {np.sqrt(uncertainty[1, 1]):.3f} rad/s {options}')
    return float(state[1, 0])


times = STEP * np.arange(1, 1001)
assert abs(speed(times[:50]) - 1.0) < 0.001
assert abs(speed(times[:200], buffer_capacity=200) - 1.0) < 0.001
for readings, expected in ((100, 0.835), (200, 0.504), (1000, -2.141)):
    assert abs(speed(times[:readings]) - expected) < 0.002
print('two encoders:')
assert abs(speed(np.repeat(times[:25], 2)) - 0.5) < 0.02
print('50 Hz:')
assert abs(speed(2 * times[:50]) - 2.0) < 0.02
PYTHON

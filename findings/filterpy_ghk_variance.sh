#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# filterpy 2.0.0: the variance of an angle that a g-h-k filter has smoothed is -0.69 of the encoder's, 0.38 is right.
#
# VRF() of a GHKFilter gives the variances of angle, speed and acceleration for a noise of the readings of 1,
# VRF_prediction() that of the predicted angle. Expected: those of the noise that comes out of the filter. What
# happens, at 100 Hz with the gains of critical_damping_parameters(0.8, 3): a negative variance of the angle; 0.0089
# for the speed, which is not divided by the square of the step, where 178 is right; and 0.45 for the prediction,
# where 0.55 is right. VRF() of a GHFilter is right. And batch_filter() of a GHKFilter ignores its gain k and its
# acceleration: of a shaft that speeds up with 30 rad/s², whose speed update() finds exactly, it gives a speed that is
# 1.2 rad/s too low. None of these is a warning.
# For us: measure the variance with noise, and call update() for each reading.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check filterpy==2.0.0 numpy==2.4.6 scipy==1.17.1
cat > "$folder/variance.py" <<'PYTHON'
import numpy as np
from filterpy.gh import GHFilter, GHKFilter, critical_damping_parameters

STEP = 0.01
two, three = critical_damping_parameters(0.8, 2), critical_damping_parameters(0.8, 3)


def filtered(one, readings):
    rows = []
    for reading in readings:
        one.update(reading)
        rows.append((one.x, one.dx, one.x_prediction))
    return np.array(rows)


noise = np.random.default_rng(0).normal(0, 1, 100000)
ghk = GHKFilter(0.0, 0.0, 0.0, STEP, *three)
measured = filtered(ghk, noise)[1000:].var(axis=0)
print('angle, speed, prediction: measured', measured, 'VRF', ghk.VRF(), 'VRF_prediction', ghk.VRF_prediction())
assert abs(ghk.VRF()[0] + 0.687) < 0.001 and abs(measured[0] - 0.38) < 0.02
assert abs(ghk.VRF()[1] - 0.0089) < 0.0001 and abs(measured[1] - 178) < 9
assert abs(ghk.VRF_prediction() - 0.447) < 0.001 and abs(measured[2] - 0.549) < 0.03

gh = GHFilter(0.0, 0.0, STEP, *two)
measured = filtered(gh, noise)[1000:].var(axis=0)
print('g-h filter: measured', measured, 'VRF', gh.VRF())
assert np.allclose(gh.VRF(), measured[:2], rtol=0.05)

times = STEP * np.arange(1, 501)
readings = 15 * times**2
speed = filtered(GHKFilter(0.0, 0.0, 0.0, STEP, *three), readings)[-1, 1]
batch = GHKFilter(0.0, 0.0, 0.0, STEP, *three).batch_filter(readings)[-1, 1]
print('speed at the end: right', 30 * times[-1], 'update()', speed, 'batch_filter()', batch)
assert abs(speed - 150) < 1e-6 and abs(batch - 148.79) < 0.05
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/variance.py"

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pysindy 2.1.0: a shaft at a constant 2 rad/s is smoothed to speeds of -14.8 to 79.9 rad/s where 0.2 s are missing.
#
# SmoothedFiniteDifference smooths the angles, then divides their differences by the times, which it is given.
# Expected: of an angle without noise at known times it gives the speed, as FiniteDifference does. What happens: the
# filter that smooths takes all steps to be equal, so that a gap bends the angles and each jitter of the times becomes
# noise of the speed. With 3 ms of jitter at 100 Hz, a model that is found by it has a stiffness of 4.54 instead of
# 4.00 and a damping of 0.24 instead of 0.20, with a score of 0.96. With equal steps all is right. There is no warning.
# For us: smooth by SINDyDerivative(kind="savitzky_golay"), which observes the times, or put the times on a grid first.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pysindy==2.1.0 derivative==0.6.3 \
    numpy==2.4.6 scipy==1.17.1 scikit-learn==1.9.1
cat > "$folder/gap.py" <<'PYTHON'
import numpy as np
import pysindy

METHODS = {
    'plain': pysindy.FiniteDifference(),
    'smoothed': pysindy.SmoothedFiniteDifference(),
    'polynomial': pysindy.SINDyDerivative(kind='savitzky_golay', left=0.05, right=0.05, order=3),
}


def speeds(times):
    found = {name: method(2 * times[:, None], times).ravel() for name, method in METHODS.items()}
    print({name: f'{speed.min():.3f} to {speed.max():.3f} rad/s' for name, speed in found.items()})
    assert abs(found['plain'] - 2).max() < 1e-6 and abs(found['polynomial'] - 2).max() < 1e-6
    return found['smoothed']


def model(times):
    """The vibration of a spring of 4 with a damping of 0.2: its stiffness, damping and score by each method."""
    rate = np.sqrt(3.99)
    angle = np.exp(-0.1 * times) * np.cos(rate * times)
    speed = np.exp(-0.1 * times) * (-0.1 * np.cos(rate * times) - rate * np.sin(rate * times))
    states = np.column_stack([angle, speed])
    found = {}
    for name, method in METHODS.items():
        one = pysindy.SINDy(pysindy.STLSQ(threshold=0.01), pysindy.PolynomialLibrary(degree=1), method)
        one.fit(states, t=times)
        _, stiffness, damping = -one.coefficients()[1]
        found[name] = np.round([stiffness, damping, one.score(states, t=times)], 3)
    print(found)
    assert abs(found['plain'][0] - 4) < 0.01 and abs(found['polynomial'][0] - 4) < 0.01
    return found['smoothed']


times = np.arange(10000) / 1000
assert abs(speeds(times) - 2).max() < 1e-6
smoothed = speeds(np.delete(times, np.arange(5000, 5200)))
assert abs(smoothed.min() + 14.8) < 0.1 and abs(smoothed.max() - 79.9) < 0.1

times = np.arange(1000) / 100
assert abs(model(times)[0] - 4) < 0.01
jitter = np.random.default_rng(0).uniform(-0.003, 0.003, 1000)
stiffness, damping, score = model(times + jitter)
assert 4.4 < stiffness < 4.7 and 0.21 < damping < 0.25 and score > 0.9
PYTHON
timeout 120 "$folder/venv/bin/python" "$folder/gap.py"

#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# PyNumDiff 0.3: a slow encoder is not smoothed by a smoothing spline: 0.1 rad/s become -1.5 to 1 rad/s, whatever s is.
#
# splinediff() documents s as a factor of smoothing: "s = 1 leaves exactly that much energy for residuals and is a good
# default; larger over-smooths", with a "robust estimate of noise stddev". A shaft turns at 0.1 ± 0.13 rad/s, and its
# encoder with counts of 1 mrad is read at 1 kHz. Expected: a speed within a few hundredths of rad/s, as of readings
# with a normal noise of two counts, and as rtsdiff() and savgoldiff() give it. What happens: -1.47 to 0.99 rad/s, an
# error of 0.28 rad/s, and the same for s = 100 or 1e9, as of most readings the second difference is 0, so that the
# noise is estimated as 0 and the spline passes through each count. There is no warning.
# For us: smooth the readings of an encoder with rtsdiff() or savgoldiff().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pynumdiff==0.3 numpy==2.4.6 scipy==1.17.1
cat > "$folder/speed.py" <<'PYTHON'
import numpy as np
from pynumdiff.kalman_smooth import rtsdiff
from pynumdiff.polynomial_fit import savgoldiff, splinediff

STEP, COUNT = 0.001, 0.001
times = STEP * np.arange(2000)
angle = 0.1 * times + 0.02 * np.sin(2 * np.pi * times)
speed = 0.1 + 0.04 * np.pi * np.cos(2 * np.pi * times)
encoder = COUNT * np.round(angle / COUNT)
noisy = angle + np.random.default_rng(0).normal(0, 2 * COUNT, times.size)


def error(found):
    return np.sqrt(np.mean((found[1] - speed) ** 2))


found = splinediff(encoder, STEP)
print('splinediff() of an encoder: speeds', found[1].min(), 'to', found[1].max(), 'rad/s, error', error(found))
print('right: speeds', speed.min(), 'to', speed.max(), 'rad/s')
assert found[1].min() < -1.3 and found[1].max() > 0.9 and error(found) > 0.25
assert np.allclose(found[0], encoder, atol=1e-9)
for smoothing in (0, 100, 1e9):
    other = splinediff(encoder, STEP, s=smoothing)
    print('s =', smoothing, 'error', error(other))
    assert np.allclose(other[1], found[1])
print('splinediff() with noise of two counts: error', error(splinediff(noisy, STEP)))
assert error(splinediff(noisy, STEP)) < 0.02
for name, other in (('rtsdiff()', rtsdiff(encoder, STEP, 2, 6)), ('savgoldiff()', savgoldiff(encoder, STEP, 2, 101, 51))):
    print(name, 'of the encoder: error', error(other))
    assert error(other) < 0.03
PYTHON
timeout 200 "$folder/venv/bin/python" -W error::RuntimeWarning "$folder/speed.py" 2> "$folder/log" || { cat "$folder/log"; exit 1; }
if grep -iE 'noise|smooth|spline' "$folder/log"; then exit 1; fi

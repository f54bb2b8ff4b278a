#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# vibration_toolbox 0.6.10: the coherence of a torque with a vibration that has nothing to do with it is 1.
#
# Expected of frf(x, f, dt): a coherence near 0 of two independent noises, and near 0.5 of a response that is half
# noise, as scipy.signal.coherence() gives. What happens: it is 1 at all frequencies for any two signals, as it is
# computed from one single spectrum, without any average; its plot shows a perfect measurement. The frequency response
# is the ratio of the magnitudes, so that noise in the response makes it too large: 1.40 times here, where an estimate
# from averaged spectra is right.
# For us: judge a measured stiffness or transmission by scipy.signal.coherence(), with 10 or more segments.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check numpy==1.26.4 scipy==1.13.1 matplotlib==3.7.5
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps vibration_toolbox==0.6.10
MPLBACKEND=Agg timeout 200 "$folder/venv/bin/python" -W ignore - <<'PYTHON'
import numpy as np
import scipy.signal
from vibration_toolbox import frf

generator = np.random.default_rng(0)
step, count = 1e-3, 2**15
torque, noise = generator.normal(size=(2, count))
for name, vibration, expected in [('independent', noise, 0), ('half noise', torque + noise, 0.5)]:
    frequency, magnitude, phase, coherence = frf(vibration, torque, step)
    averaged = scipy.signal.coherence(torque, vibration, 1 / step, nperseg=512)[1]
    print(name, 'coherence', coherence.min(), 'to', coherence.max(), 'SciPy', averaged.mean())
    assert abs(coherence - 1).max() < 1e-6
    assert abs(averaged.mean() - expected) < 0.05
power = scipy.signal.welch(torque, nperseg=512)[1]
cross = scipy.signal.csd(torque, torque + noise, nperseg=512)[1]
print('frequency response of 1 rad/(N·m): median', np.median(magnitude), 'from averages', np.median(abs(cross / power)))
assert np.median(magnitude) > 1.2 and abs(np.median(abs(cross / power)) - 1) < 0.05
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pylife 2.3.1: a vibration at 3.00 Hz in a record of 12.5 Hz is found at 2.88 Hz, and one at 190 Hz at 10 Hz.
#
# Expected of psd_df(), which takes the rate of a record from its times: a peak at 3.00 Hz. What happens: the rate is
# rounded to whole hertz, 12, without a warning, so that all frequencies are 4 % too low; butter_bandpass() has its
# corners by the same rate. At 1 kHz it is right. resample_acc() from 1 kHz to 200 Hz interpolates without a low-pass,
# so that a gear mesh at 190 Hz is a vibration at 10 Hz of the same power.
# For us: use scipy.signal.welch() with the measured rate, and a low-pass before a record is resampled.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pylife==2.3.1 numpy==2.4.6
timeout 120 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
import pandas as pd
from pylife.stress.timesignal import psd_df, resample_acc


def record(frequency, rate, seconds):
    times = np.arange(round(seconds * rate)) / rate
    return pd.DataFrame({'torque': np.sin(2 * np.pi * frequency * times)}, index=times)


def peak(samples, points):
    """Return the frequency with the greatest density, and the power of all frequencies."""
    density = psd_df(samples, nfft=points, nperseg=points)['torque']
    return density.idxmax(), density.sum() * density.index[1]


slow, fast = peak(record(3.0, 12.5, 400), 2500), peak(record(3.0, 1000, 100), 20000)
mesh = peak(resample_acc(record(190, 1000, 20), 200), 2000)
mesh = tuple(map(float, mesh))
print(f'3 Hz sampled at 12.5 Hz: {slow[0]:.3f} Hz; at 1 kHz: {fast[0]:.3f} Hz; 190 Hz resampled to 200 Hz: {mesh}')
assert abs(slow[0] - 2.88) < 0.01 and abs(fast[0] - 3) < 0.06
assert abs(mesh[0] - 10) < 0.2 and abs(mesh[1] - 0.5) < 0.05
PYTHON

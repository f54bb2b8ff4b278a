#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# SignalProcessingTools 1.2.7: a gear mesh at 250 Hz is found at 254 Hz, and a record of 100 Hz is taken as one of 101.
#
# Expected of TimeSignalProcessing.fft() with windows of 64 readings at 1 kHz: a vibration of 250 Hz at 250 Hz, as line
# k of a discrete Fourier transform is at k/64 of 1 kHz, and this one is in the middle of line 16. What happens: 253.97
# Hz, as the lines are spread from 0 to 1 kHz with both ends. Expected of a record of 100 Hz whose times are given,
# which is "computed based on time": 100 Hz. What happens with 2000 readings at 0, 0.01, 0.02 s and so on: 101 Hz, as
# the mean interval is 0.01 s but for rounding and its inverse is rounded up; a vibration of 20 Hz is at 20.2 Hz.
# For us: give Fs, and multiply the frequencies by (n - 1)/n, where n is the length of the window or of the record.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check SignalProcessingTools==1.2.7 numpy==2.4.6 scipy==1.17.1
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import numpy as np
from SignalProcessingTools.time_signal import TimeSignalProcessing, Windows


def vibration(frequency, rate, count, **options):
    times = np.arange(count) / rate
    return TimeSignalProcessing(times, np.sin(2 * np.pi * frequency * times), **options)


def peak(record):
    return record.frequency[np.argmax(record.amplitude)]


mesh = vibration(250, 1000, 10_000, Fs=1000, window=Windows.HANN, window_size=64)
mesh.fft()
print('250 Hz at 1 kHz in windows of 64:', peak(mesh), 'Hz, amplitude', mesh.amplitude.max())
assert abs(peak(mesh) - 250 * 64 / 63) < 1e-6 and mesh.amplitude.max() > 0.99

slow = vibration(20, 100, 2000)
slow.fft()
print('20 Hz at 100 Hz:', peak(slow), 'Hz, taken as a record of', slow.Fs, 'Hz')
assert slow.Fs == 101 and abs(peak(slow) - 20.2) < 0.05
PYTHON

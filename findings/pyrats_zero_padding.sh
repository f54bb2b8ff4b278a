#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pyRaTS 0.21: after zero padding by 4, a gear mesh at 100 Hz is at 25 Hz, and each integral of a record is NaN.
#
# A vibration at 100 Hz, 10 s at 1 kHz. Expected of der_zeropadded(4), which puts samples between the measured ones so
# that the extremes between these count: 40 000 samples in the same 10 s, at 4 kHz. What happens: the samples are right,
# but the new record has the old rate of 1 kHz, so that it lasts for 40 s: its spectrum, its crossings of zero a second,
# its load cycles a second and each response that is computed from it are those of a vibration at 25 Hz.
# der_deriviative('int') and ('intint') divide by the frequency 0 and give only NaN; 'int' has the formula of two
# integrations, and 'intint' that of one.
# For us: make a new tsarr() with the samples and four times the rate, and integrate by numpy.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    pyRaTS==0.21 numpy==1.26.4 scipy==1.17.1 rainflow==3.2.0 FLife==2.3 tqdm==4.70.1 matplotlib==3.11.2
cd "$folder"
MPLBACKEND=agg timeout 100 venv/bin/python -W ignore - <<'PYTHON'
import numpy as np
import pyRaTS

RATE, FACTOR = 1000, 4
times = np.arange(0.0, 10.0, 1 / RATE)
record = pyRaTS.tsarr(np.sin(2 * np.pi * 100 * times), fs=RATE)
padded = record.der_zeropadded(FACTOR)
ideal = np.sin(2 * np.pi * 100 * np.arange(times.size * FACTOR) / (RATE * FACTOR))
assert np.allclose(padded.x, ideal)
for name, series in (('record', record), ('padded', padded)):
    line = series.fpsd[np.argmax(series.psd)]
    print(name, 'rate', series.fs, 'duration', series.T, 'line', line, 'Hz, crossings', series.ls['nzerocrossings_ps'])
assert (padded.fs, padded.T, padded.fpsd[np.argmax(padded.psd)]) == (RATE, 40.0, 25.0)
right = pyRaTS.tsarr(padded.x, fs=RATE * FACTOR)
assert (right.T, right.fpsd[np.argmax(right.psd)]) == (10.0, 100.0)

for kind in ('int', 'intint'):
    angles = record.der_deriviative(kind).x
    print(kind, angles[:3])
    assert np.isnan(angles).all()
PYTHON

#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mdof 0.0.23: a vibration of 0.3 : -0.7 : 1 at three sensors has the shape 1 : 0.84 : 0.78, as 0.3 : 0.7 : 1 has.
#
# outid() is documented to identify "Fundamental periods and modeshapes" from recorded outputs, and transform.fdd() to
# decompose their spectra. An arm vibrates at 2 Hz and 5 Hz with known shapes. Expected: these shapes, as an FDD by
# csd() and svd() finds them. What happens: 1 : 0.84 : 0.78 instead of 0.3 : -0.7 : 1, and 1 : 0.28 : 0.39 instead of
# 1 : 0.5 : -0.7. The matrix of cross spectra is made of the absolute values of the spectra, so that all signs are lost,
# and its elements are put at wrong places: element (1, 2) and the last of its diagonal stay 0. The three periods are
# all that of the first mode. There is no warning.
# For us: identify shapes with csd() and svd(), as below.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mdof==0.0.23 numpy==2.4.6 scipy==1.17.1
cat > "$folder/shapes.py" <<'PYTHON'
import mdof
import numpy as np
from scipy.signal import csd, lfilter

STEP = 0.005
SHAPES = np.array([[0.3, -0.7, 1.0], [1.0, 0.5, -0.7]])


def vibration(noise, frequency, damping):
    pole = np.exp((-damping + 1j * np.sqrt(1 - damping**2)) * 2 * np.pi * frequency * STEP)
    moved = lfilter([0, pole.imag], [1, -2 * pole.real, abs(pole) ** 2], noise)
    return moved / moved.std()


def scaled(shape):
    return shape / shape[np.argmax(np.abs(shape))]


noise = np.random.default_rng(0).normal(size=(2, 40000))
outputs = SHAPES.T @ np.vstack((vibration(noise[0], 2.0, 0.01), vibration(noise[1], 5.0, 0.01)))
periods, shapes = mdof.outid(outputs, STEP)
print('outid(): frequencies', 1 / periods, 'Hz, shape', scaled(shapes[:, 0]).round(2))
assert np.allclose(periods, periods[0])

lines, vectors, values = mdof.transform.fdd(outputs, STEP)
spectral = [[csd(one, other, fs=1 / STEP, nperseg=4096) for other in outputs] for one in outputs]
frequencies, matrices = spectral[0][0][0], np.array([[pair[1] for pair in row] for row in spectral])
for mode, right, found in ((2.0, SHAPES[0], (1, 0.84, 0.78)), (5.0, SHAPES[1], (1, 0.28, 0.39))):
    near = np.flatnonzero(np.abs(lines - mode) < 0.1)
    mistaken = scaled(vectors[:, 0, near[np.argmax(values[0, near])]])
    near = np.flatnonzero(np.abs(frequencies - mode) < 0.1)
    peak = near[np.argmax([np.linalg.svd(matrices[:, :, line])[1][0] for line in near])]
    identified = scaled(np.linalg.svd(matrices[:, :, peak])[0][:, 0]).real
    print(mode, 'Hz: right', scaled(right), 'fdd()', mistaken.round(2), 'csd() and svd()', identified.round(2))
    assert np.allclose(mistaken, found, atol=0.02) and np.allclose(identified, scaled(right), atol=0.05)
for sine in ((0.3, 0.7, 1.0), (0.3, -0.7, 1.0), (-0.3, -0.7, 1.0)):
    _, shapes = mdof.outid(np.outer(sine, np.sin(2 * np.pi * 2 * STEP * np.arange(40000))), STEP)
    print('one sine of', sine, 'outid()', scaled(shapes[:, 0]).round(2))
    assert np.allclose(scaled(shapes[:, 0]), (1, 0.84, 0.78), atol=0.01)
PYTHON
timeout 200 "$folder/venv/bin/python" "$folder/shapes.py" 2> "$folder/log" || { cat "$folder/log"; exit 1; }
if [ -s "$folder/log" ]; then cat "$folder/log"; exit 1; fi

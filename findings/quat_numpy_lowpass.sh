#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# quat-numpy 0.2.0: the attitude of an arm behind a low-pass is right about x, and up to 37° off about y or z.
#
# The README documents qconv() as quaternion convolution and applies a kernel of lowpass() with it. An arm swings by
# ±60° at 0.5 Hz, and its attitude is filtered by 21 coefficients at 100 Hz. Expected: the angle again, as each
# component filtered by itself gives it to 0.02°. What happens: about x it is right; about y and z it is up to 37° off,
# as the components y and z come 20 samples early: the spectra of two complex numbers are multiplied like quaternions,
# which is a convolution only for the first two components. Of two general series, qconv() is not the sum of their
# products either. And a lowpass(5, 0.05) makes 0.22 of a constant 1. There is no warning of any of these.
# For us: filter each of the four components by numpy.convolve(), and divide the kernel by its sum.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check quat-numpy==0.2.0 numpy==2.4.6
timeout 100 "$folder/venv/bin/python" -W ignore::RuntimeWarning - <<'PYTHON'
import numpy as np
from quat.algebra import _hamilton
from quat.signal import lowpass, qconv

angle = np.radians(60) * np.sin(2 * np.pi * 0.5 * 0.01 * np.arange(400))
kernel = lowpass(21, 0.1)._data
inner = slice(50, 350)


def turned(quaternions, axis):
    return 2 * np.arctan2(quaternions[:, axis], quaternions[:, 0])


def lag(filtered):
    """Return by how many samples the filtered angle is late."""
    shifts = list(range(-30, 31))
    return shifts[int(np.argmax([filtered[inner] @ np.roll(angle, shift)[inner] for shift in shifts]))]


for axis, greatest, late in ((1, 0.1, 0), (2, 37, -20), (3, 37, -20)):
    attitudes = np.zeros((angle.size, 4))
    attitudes[:, 0], attitudes[:, axis] = np.cos(angle / 2), np.sin(angle / 2)
    filtered = qconv(attitudes, kernel, 'same')
    right = np.column_stack([np.convolve(component, kernel[:, 0], 'same') for component in attitudes.T])
    errors = [np.degrees(np.abs(turned(one, axis) - angle)[inner].max()) for one in (filtered, right)]
    part = lag(filtered[:, axis])
    print(f'about {"xyz"[axis - 1]}: qconv() {errors[0]:.2f}° off, its component {part} samples late; right {errors[1]:.2f}°')
    assert abs(errors[0] - greatest) < 1 and errors[1] < 0.1 and abs(part - late) <= 1

generator = np.random.default_rng(0)
one, other, product = generator.normal(size=(6, 4)), generator.normal(size=(3, 4)), np.zeros((8, 4))
for i, left in enumerate(one):
    for j, right in enumerate(other):
        product[i + j] += _hamilton(left, right)
print('qconv() less the sum of products: up to', np.abs(qconv(one, other) - product).max())
assert np.abs(qconv(one, other) - product).max() > 1

for length, cutoff, found in ((5, 0.05, 0.221), (21, 0.1, 1.004)):
    gain = lowpass(length, cutoff)._data[:, 0].sum()
    print(f'lowpass({length}, {cutoff}): a constant 1 comes out as {gain:.3f}')
    assert abs(gain - found) < 0.002
PYTHON

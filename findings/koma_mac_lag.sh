#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# koma-python 1.3.6: two shapes of vibration are alike by 81, where 1 is the most, and a delay of 100 ms is 81 ms.
#
# mac() is the modal assurance criterion of two shapes, 1 for equal ones and 0 for those that have nothing in common.
# What happens for complex shapes, as an identification gives them: the products that normalize it are without a
# conjugate, so that the shape (1, i, 0.5) and its conjugate have 81, and xmacmat(..., conjugates=False) gives 0.012.
# estimate_lags() finds the delay between two encoders by their correlation. With upsample=10 a delay of 100 ms is
# right by the methods 'fourier' and 'linear'; by 'poly', which takes the factor as the number of samples of the whole
# record, it is between -9 ms and 9 ms. Where both angles are 5 rad larger, it is 81 ms by 'fourier', as the means are
# not subtracted. None of these is an error or a warning.
# For us: use xmacmat(), subtract the means before estimate_lags(), and leave its method 'poly' alone.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check koma-python==1.3.6 numpy==2.4.6 scipy==1.17.1
cat > "$folder/alike.py" <<'PYTHON'
import numpy as np
from koma.modal import mac, xmacmat
from koma.signal import estimate_lags

shape = np.array([1, 1j, 0.5])
given, right = mac(shape, shape.conj()), xmacmat(shape, shape.conj(), conjugates=False)
print('alike by', given, 'right', right, 'a shape with itself', mac(shape, shape))
assert abs(given - 81) < 1e-9 and abs(right - (0.25 / 2.25) ** 2) < 1e-9
real = np.array([1, -0.7, 0.5])
assert np.isclose(mac(real, real), 1) and np.isclose(mac(real, real[::-1]), xmacmat(real, real[::-1]))


def angle(times):
    frequencies = np.array([0.7, 1.9, 4.3])
    return np.sin(2 * np.pi * np.outer(times, frequencies) + [0, 1, 0]) @ [1, 0.5, 0.3]


times = np.arange(2000) / 100
for mean, expected in (0.0, 0.1), (5.0, 0.081):
    angles = np.column_stack([angle(times), angle(times - 0.1)]) + mean
    lags = {
        method: float(estimate_lags(angles, upsample=10, fs=100.0, upsample_method=method)[1])
        for method in ('fourier', 'linear', 'poly')
    }
    print('around', mean, 'rad: delays of 0.1 s are', lags)
    assert abs(lags['fourier'] - expected) < 0.0015 and abs(lags['linear'] - expected) < 0.0025
    assert abs(lags['poly']) < 0.0095
PYTHON
timeout 120 "$folder/venv/bin/python" "$folder/alike.py"

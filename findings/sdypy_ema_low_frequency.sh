#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# sdypy-EMA 0.31.0: a vibration of an arm at 20 Hz is found at 0 Hz with a damping of 0; one at 26 Hz is found right.
#
# An arm has natural frequencies at 20 Hz and 55 Hz, and its frequency responses have next to no noise. Expected of
# select_closest_poles([20, 55]): 20 Hz with a damping ratio of 0.01 and 55 Hz with 0.02, which are among the poles
# that it has found. What happens: 0 Hz and 0 are given for the first one without a warning. Poles that are not stable
# are kept as zeros, and the first search goes over ±25 Hz, so that the zeros draw each frequency below 25 Hz to 0.
# For us: give f_window=10 to select_closest_poles(), or less than the lowest frequency, and look for a frequency of
# 0.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check sdypy-EMA==0.31.0 numpy==2.4.6 scipy==1.17.1
cat > "$folder/arm.py" <<'PYTHON'
import warnings

import numpy as np
from sdypy import EMA

DAMPING = np.array([0.01, 0.02])
SHAPES = np.array([[1, 1], [1.5, -0.7], [0.5, 1.2]])
warnings.simplefilter('error')  # nothing warns of a frequency of 0


def identified(lowest, **window):
    natural = 2 * np.pi * np.array([lowest, lowest + 35])
    frequencies = np.arange(0, 200, 0.1)
    speeds = 2 * np.pi * frequencies
    response = sum(
        np.outer(SHAPES[:, mode] * SHAPES[0, mode], -(speeds**2))
        / (natural[mode] ** 2 - speeds**2 + 2j * DAMPING[mode] * natural[mode] * speeds)
        for mode in range(2)
    )
    noise = np.random.default_rng(0).standard_normal((2, *response.shape))
    response += 1e-4 * abs(response).max() * (noise[0] + 1j * noise[1])
    model = EMA.Model(response, frequencies, lower=5, upper=150, pol_order_high=20, frf_form='accelerance')
    model.get_poles()
    model.select_closest_poles([lowest, lowest + 35], **window)
    print(lowest, 'Hz', window, 'found at', model.nat_freq, 'Hz with', model.nat_xi)
    is_right = np.allclose(model.nat_freq, [lowest, lowest + 35], atol=0.05) and np.allclose(model.nat_xi, DAMPING, atol=1e-3)
    return model.nat_freq[0], model.nat_xi[0], is_right


for lowest in 10, 20, 24:
    frequency, damping, is_right = identified(lowest)
    assert frequency == 0 and damping == 0 and not is_right
for lowest in 26, 40:
    assert identified(lowest)[2]
assert identified(20, f_window=10)[2]
PYTHON
timeout 120 "$folder/venv/bin/python" "$folder/arm.py" 2> "$folder/log" || { cat "$folder/log"; exit 1; }

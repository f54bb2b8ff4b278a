#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pylablib 1.4.5: a gear mesh at 50 Hz is at 41 Hz in a spectrum of a truncated record, and a cut record loses its ends.
#
# Expected of power_spectral_density(record, truncate=2), which truncates 10 000 samples to the 8192 of a fast Fourier
# transform: a peak at 50 Hz. What happens: the frequencies are those of all 10 000 samples, so that each is multiplied
# by 8192/10 000, and the power, which is to be the mean of the squares, is as much too small. fourier_transform() with
# the same argument has it at 50 Hz. Without truncate, and where nothing is to be truncated, both are right.
# Expected of cut_to_range(record, (0, 19), ordered=True) of a record from 0 to 19 s: the whole of it, as without
# ordered=True, which says that its times are in order. What happens: the first and the last sample are missing, as a
# search for a sample at or after 0 s never gives the first. A range inside of the record has both of its ends.
# No error, no warning.
# For us: take truncate=False and ordered=False, the defaults.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --no-compile --disable-pip-version-check numpy==2.4.6 scipy==1.17.1 pandas==3.1.1
"$folder/venv/bin/pip" install --quiet --no-compile --disable-pip-version-check --no-deps pylablib==1.4.5
timeout 120 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from pylablib.core.dataproc import fourier, utils

times = np.arange(10_000) / 1000
record = np.column_stack((times, np.sin(2 * np.pi * 50 * times)))
peaks, powers = {}, {}
for truncate in False, 2:
    density = fourier.power_spectral_density(record, truncate=truncate)
    transform = fourier.fourier_transform(record, truncate=truncate, normalization='density')
    step = density[1, 0] - density[0, 0]
    peaks[truncate] = [abs(density[density[:, 1].argmax(), 0]), abs(transform[abs(transform[:, 1]).argmax(), 0])]
    powers[truncate] = density[:, 1].sum() * step
print('peaks of the density and of the transform by truncate', peaks, 'Hz; powers', powers)
assert np.allclose(peaks[False], 50) and np.allclose(peaks[2], (41, 50), atol=0.1)
assert np.allclose((powers[False], powers[2]), (0.5, 0.5 * 8192 / 10_000), rtol=0.01)

turn = np.column_stack((np.arange(20.0), np.arange(20.0) ** 2))
for first, last, lost in ((0, 19, 2), (0, 7, 1), (3, 7, 0)):
    whole = utils.cut_to_range(turn, (first, last))
    ordered = utils.cut_to_range(turn, (first, last), ordered=True)
    print(f'{first} to {last} s: {whole[0, 0]} to {whole[-1, 0]}, ordered {ordered[0, 0]} to {ordered[-1, 0]}')
    assert len(whole) == last - first + 1 and len(whole) - len(ordered) == lost
PYTHON

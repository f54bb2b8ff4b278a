#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# endaq 1.5.3: a vibration of 1 g RMS has 2 g in a rolling PSD with bins of 0.25 Hz, which overlooks 60 % of the record.
#
# A gear mesh of 1 g RMS at 50 Hz is recorded for 60 s at 1 kHz. Expected of rolling_psd() with scaling='rms', from 10
# to 100 Hz, in 100 slices: 1 g in each of about 100 slices. What happens with bin_width=0.25: 2 g in 6 slices; with
# 2 Hz: 0.71 g in 397. The sum of the density is not multiplied by the width of a bin, and the step from slice to slice,
# which is to be a hundredth of the record, is divided by the square of the width. Only 4 s of each 9.6 s are looked
# at, so that a blow of 5 g for 1 s between two slices is nowhere in the result. With a width of 1 Hz, the default, and
# for slices that are given by index_values, the RMS is right.
# fft.dct() gives the sine transform of SciPy, and fft.dst() its cosine transform. No error, no warning.
# For us: take psd.welch(..., scaling='parseval') of each slice, and sum it.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --no-compile --disable-pip-version-check \
    endaq==1.5.3 idelib==3.4.0 ebmlite==3.4.1 plotly==7.1.0 numpy==2.4.6 pandas==3.1.1 scipy==1.17.1
timeout 120 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
import pandas as pd
import scipy.fft
from endaq.calc import fft, psd

times = np.arange(60_000) / 1000


def rolling(values, width, **places):
    record = pd.DataFrame({'z': values}, index=pd.Index(times, name='time'))
    return psd.rolling_psd(record, bin_width=width, scaling='rms', freq_splits=[10, 100], **places)


vibration = np.sqrt(2) * np.sin(2 * np.pi * 50 * times)
for width, rms, number in ((1, 1, 99), (0.25, 2, 6), (2, 2**-0.5, 397)):
    slices = rolling(vibration, width, num_slices=100)
    places = slices.timestamp.nunique()
    middle = rolling(vibration, width, index_values=[30.0], slice_width=6)
    print(f'{width} Hz: {slices.value.median():.3f} g in {places} slices; by place {middle.value[0]:.3f} g')
    assert np.allclose(slices.value, rms) and places == number and np.allclose(middle.value, 1)

blow = np.where((times >= 6) & (times < 7), 5 * np.sin(2 * np.pi * 50 * times), 0)
greatest = {width: rolling(blow, width, num_slices=100).value.max() for width in (1, 0.25)}
print('greatest RMS of a record with a blow, by width', greatest)
assert greatest[1] > 3 and greatest[0.25] < 1e-9

short = pd.DataFrame({'z': vibration[:8]}, index=times[:8])
for ours, other in ((fft.dct, scipy.fft.dst), (fft.dst, scipy.fft.dct)):
    assert np.allclose(ours(short, norm='ortho').z, other(vibration[:8], norm='ortho'))
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# vibdata 1.1.4: normalized to another sample rate, a gear mesh at 100 Hz is at 1000 Hz, if the record lasts for 10 s.
#
# A vibration at 100 Hz, recorded at 10 kHz. Expected of NormalizeSampleRate(5000): the same vibration at 5 kHz, 5000
# samples for each second. What happens: it makes 5000 samples of each record, however long it is, and says that they
# are at 5 kHz: of 1 s it is right, of 2 s it is a vibration at 200 Hz, and of 10 s one at 1000 Hz. It does not filter
# either: from 10 kHz to 1 kHz, a line at 900 Hz in a record of 1 s becomes one at 100 Hz. NormalizeSampleRatePoly() is
# right. No warning.
# For us: use NormalizeSampleRatePoly().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps vibdata==1.1.4
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    essentia==2.1b6.dev1389 opencv-python-headless==5.0.0.93 scikit-learn==1.9.1 \
    numpy==2.4.6 scipy==1.17.1 pandas==3.1.1 cloudpickle==3.1.3 2> "$folder/log" || { cat "$folder/log"; exit 1; }
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON' 2> log || { cat log; exit 1; }
import numpy as np
import pandas as pd
from vibdata.deep.signal.transforms import NormalizeSampleRate, NormalizeSampleRatePoly

RATE = 10_000


def line(transform, frequency, seconds):
    signal = np.sin(2 * np.pi * frequency * np.arange(seconds * RATE) / RATE)
    data = transform.transform({'signal': np.array([signal]), 'metainfo': pd.DataFrame({'sample_rate': [RATE]})})
    values, rate = data['signal'][0], data['metainfo']['sample_rate'].iloc[0]
    frequencies = np.fft.rfftfreq(values.size, 1 / rate)
    return round(float(frequencies[np.argmax(np.abs(np.fft.rfft(values)))]))


lengths = (1, 2, 10)
for kind in (NormalizeSampleRate, NormalizeSampleRatePoly):
    print(kind.__name__, 'of 100 Hz in 1, 2 and 10 s:', [line(kind(5000), 100, seconds) for seconds in lengths])
assert [line(NormalizeSampleRate(5000), 100, seconds) for seconds in lengths] == [100, 200, 1000]
assert [line(NormalizeSampleRatePoly(5000), 100, seconds) for seconds in lengths] == [100, 100, 100]
print('of 900 Hz at 1 kHz:', line(NormalizeSampleRate(1000), 900, 1))
assert 95 <= line(NormalizeSampleRate(1000), 900, 1) <= 105
PYTHON

#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# viblearn 0.1.1: in windows of 128 samples, a gear mesh at 1000 Hz is found at 508 Hz, with the default settings.
#
# `PSDAnalyzer` gives the spectra of windows of a vibration, and `frequencies()` their axis. Expected for windows that
# are shorter than `nperseg`, which is 256 by default: an error, or a shorter axis. What happens: the spectrum is that
# of a shorter segment, whose bins are twice as wide for 128 samples, filled up with zeros at its end, while the axis
# stays that of 256 samples. So each frequency is halved, the names of the features are wrong too, and nothing warns.
# Expected of its limits by standards: those of the standards. What happens: `api_670_limit()` lets a shaft at 3000 rpm
# move by 219 mils (5.6 mm) peak to peak, as it has 12000/sqrt(N), which its documentation calls the formula of API 670;
# the limit in the standards of API is sqrt(12000/N) mils, here 2.0 (51 um). By `iso_10816_3_severity()`, 5 mm/s are
# "acceptable for unrestricted long-term operation" of a medium machine, from 15 to 300 kW, on a rigid foundation (its
# default). The boundaries for these (group 2, rigid) in ISO 10816-3 are 1.4, 2.8 and 4.5 mm/s: 5 mm/s is in zone D.
# Output: nperseg 256: 508 Hz; nperseg 128: 1016 Hz
#         3000 rpm: 219.1 mils, 40 mils (1 mm) exceed it: False
#         5 mm/s: zone B, acceptable True
# For us: set `nperseg` to no more than the length of a window, and take the limits from the standards.
#
# Exit code 0: still so. Installs the version into a temporary folder, without torch, which these parts do not need.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps viblearn==0.1.1 \
    numpy==2.4.6 scipy==1.17.1 scikit-learn==1.9.1 joblib==1.6.0 threadpoolctl==3.8.0 cloudpickle==3.1.3 \
    narwhals==2.29.0
cd "$folder"
timeout 120 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from viblearn.features import PSDAnalyzer
from viblearn.standards import api_670_limit, iso_10816_3_severity

RATE, MESH = 10_000.0, 1000.0
window = np.sin(2 * np.pi * MESH * np.arange(128) / RATE)


def found(**settings):
    analyzer = PSDAnalyzer(fs=RATE, **settings)
    spectrum = analyzer.fit_transform(window.reshape(1, -1))[0]
    assert len(spectrum) == len(analyzer.frequencies())
    name = analyzer.get_feature_names_out()[spectrum.argmax()]
    frequency = analyzer.frequencies()[spectrum.argmax()]
    assert name == f'psd_{frequency:.2f}hz', name
    return frequency


print(f'nperseg 256: {found():.0f} Hz; nperseg 128: {found(nperseg=128):.0f} Hz')
assert abs(found() - MESH / 2) < RATE / 256
assert abs(found(nperseg=128) - MESH) < RATE / 128

limit = api_670_limit(3000)
print(f'3000 rpm: {limit.limit_mils_pp:.1f} mils, 40 mils (1 mm) exceed it: {limit.exceeds_limit(40)}')
assert abs(limit.limit_mils_pp - 12000 / 3000 ** 0.5) < 1e-9 and (12000 / 3000) ** 0.5 == 2.0
assert not limit.exceeds_limit(40)

severity = iso_10816_3_severity(5.0)
print(f'5 mm/s: zone {severity.zone}, acceptable {severity.is_acceptable()}')
assert severity.zone == 'B' and severity.is_acceptable() and severity.machine_class == 2
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# viblearn 0.1.1: a gear mesh at 1000 Hz is at 508 Hz in the power spectrum of a window of 128 samples, and at 781 Hz in
# one of 200.
#
# Expected of PSDAnalyzer(fs=10000, nperseg=256): a vibration of 1000 Hz has its line at 1000 Hz in windows of any
# length, as in those of 1000 samples. What happens: a window that is shorter than nperseg is taken as one short
# segment, but frequencies() and the names of the features stay those of 256 samples, and the missing lines are filled
# with zeros. The frequency is too low by the ratio of the two lengths, and so is the power, and no error says so.
# iso_10816_3_severity(7.0, machine_class=4) rates 7.0 mm/s as zone A, that of new machines, which ends at 3.5 mm/s in
# ISO 10816-3.
# For us: give nperseg at most the length of the windows, or take scipy.signal.welch.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 scipy==1.17.1 scikit-learn==1.9.1
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps viblearn==0.1.1
cd "$folder"
timeout 100 venv/bin/python - <<'PYTHON'
import numpy as np
from viblearn.features import PSDAnalyzer
from viblearn.standards import iso_10816_3_severity

RATE, MESH = 10000, 1000


def line(samples):
    """The frequency of the greatest line, its name, and the mean square by the area below the spectrum."""
    analyzer = PSDAnalyzer(fs=RATE, nperseg=256)
    [spectrum] = analyzer.fit_transform(np.sin(2 * np.pi * MESH * np.arange(samples) / RATE).reshape(1, -1))
    greatest = np.argmax(spectrum)
    frequencies = analyzer.frequencies()
    found = float(frequencies[greatest]), float(np.trapezoid(spectrum, frequencies))
    print(samples, 'samples: line at', found[0], 'Hz,', analyzer.get_feature_names_out()[greatest], 'mean square', round(found[1], 3))
    return found


for samples, factor in ((1000, 1), (256, 1), (200, 200 / 256), (128, 128 / 256)):
    frequency, mean_square = line(samples)
    assert abs(frequency - factor * MESH) < 40 and abs(mean_square - factor * 0.5) < 0.01
severity = iso_10816_3_severity(7.0, machine_class=4)
print(severity)
assert severity.zone == 'A'
PYTHON

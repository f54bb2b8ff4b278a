#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# picoquake 1.2.0: a vibration of 1 g has 0.5 g in its spectrum, and a record of 5 s that lost 1 s lasts for 4 s.
#
# The library of a USB sensor of vibration draws the spectrum of a record on an axis "Amplitude [g]", and documents
# `duration` as the duration of the acquisition in seconds. Expected of a sine of 1 g at 100 Hz, of which whole periods
# fit into the record: 1 g at 100 Hz. What happens: the samples are weighted with a Hann window, and the result is not
# divided by its mean of 0.5, so that each amplitude is half. The spectral density of plot_psd() is right. Samples that
# were lost are counted as skipped, but the duration is the number of the others over the rate; the times of the plots
# are right. For us: double the amplitudes of plot_fft(), and take the duration from the first and last count.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    picoquake==1.2.0 matplotlib==3.11.2 numpy==2.4.6 scipy==1.17.1
cat > "$folder/amplitude.py" <<'PYTHON'
import sys
from datetime import datetime
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from picoquake.configuration import AccRange, Config, Filter, GyroRange, SampleRate
from picoquake.data import AcquisitionData, DeviceInfo, IMUSample
from picoquake.plot import plot_fft, plot_psd

RATE, SECONDS, FREQUENCY = 1000, 5, 100
config = Config(SampleRate.hz_1000, Filter.hz_258, AccRange.g_4, GyroRange.dps_250)


def record(counts):
    samples = [IMUSample(int(n), np.sin(2 * np.pi * FREQUENCY * n / RATE), 0.0, 0.0, 0.0, 0.0, 0.0) for n in counts]
    return AcquisitionData(samples, DeviceInfo('0123456789ABCDEF', '1.0'), config, datetime(2026, 1, 1))


def highest(draw):
    draw(record(np.arange(RATE * SECONDS)), str(Path(sys.argv[1]) / 'spectrum.png'), axis='x')
    frequencies, heights = plt.gca().get_lines()[0].get_data()
    best = int(np.argmax(heights))
    power = float(np.sum(heights) * (frequencies[1] - frequencies[0]))
    plt.close('all')
    return float(frequencies[best]), float(heights[best]), power


frequency, amplitude, _ = highest(plot_fft)
power = highest(plot_psd)[2]
print(f'spectrum: {amplitude:.3f} g at {frequency:.1f} Hz; from the density: {np.sqrt(2 * power):.3f} g')
assert abs(frequency - FREQUENCY) < 0.01 and abs(amplitude - 0.5) < 0.01 and abs(np.sqrt(2 * power) - 1) < 0.02

counts = np.arange(RATE * SECONDS)
lossy = record(counts[(counts < 2000) | (counts >= 3000)])
print(f'record of {SECONDS} s: {lossy.duration} s, skipped {lossy.skipped_samples} samples')
assert lossy.skipped_samples == 1000 and lossy.duration == 4.0 and record(counts).duration == 5.0
PYTHON
MPLBACKEND=Agg MPLCONFIGDIR="$folder" timeout 100 "$folder/venv/bin/python" -W ignore "$folder/amplitude.py" "$folder"

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pymodal 0.2.1: a resonance at 100 Hz is at 101 Hz in a record of 0.1 s, and a vibration at 900 Hz is at 100 Hz.
#
# The response of an arm to a torque, 100 samples at 1 kHz, with a resonance at 100 Hz. Expected of to_FRF(): lines 10 Hz
# apart, one over the length of the record, and the resonance at 100 Hz. What happens: they are 10.1 Hz apart, one over
# the time from the first to the last sample, so that each frequency is n/(n-1) too high, and the greatest is 505.05 Hz,
# beyond half the rate. Expected of change_sampling_rate(1000) of a vibration at 900 Hz, sampled at 8 kHz: next to
# nothing, as 1 kHz cannot show it. What happens: each eighth sample is kept without a filter, and it is a vibration at
# 100 Hz with 95 % of its amplitude. The record itself is changed, although the method returns a record. No warning.
# For us: give frf() the right freq_resolution, and filter with scipy.signal.decimate() before.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    pymodal==0.2.1 pyFRF==1.5.0 numpy==2.4.6 scipy==1.17.1 pint==0.25.3 h5py==3.16.0
cd "$folder"
MPLBACKEND=agg timeout 100 venv/bin/python - <<'PYTHON'
import numpy as np
from pymodal import timeseries

RATE, SAMPLES, RESONANCE = 1000.0, 100, 100.0
lines = np.fft.rfftfreq(SAMPLES, 1 / RATE)
ideal = 1 / (RESONANCE**2 - lines**2 + 0.02j * RESONANCE * lines)
force = np.random.default_rng(1).standard_normal(SAMPLES)
motion = np.fft.irfft(np.fft.rfft(force) * ideal, SAMPLES)

excitation = timeseries(force.reshape(-1, 1, 1), time_step=1 / RATE, method='excitation')
response = timeseries(motion.reshape(-1, 1, 1), time_step=1 / RATE, measurements_units='meter')
found = response.to_FRF(excitation)
receptance = found.measurements[0][()][:, 0, 0]
assert np.allclose(receptance[1:-1], ideal[1:-1])  # the values are right, and belong to these lines
peak = found.freq_array[np.argmax(np.abs(receptance))]
print('resonance at', peak, 'Hz, greatest frequency', found.freq_array[-1], 'Hz')
assert abs(peak - 1000 / 9.9) < 1e-9 and abs(found.freq_array[-1] - 50000 / 99) < 1e-6

vibration = np.sin(2 * np.pi * 900 * np.arange(8000) / 8000)
record = timeseries(vibration.reshape(-1, 1, 1), time_step=1 / 8000)
resampled = record.change_sampling_rate(1000.0)
values = resampled.measurements[0][()][:, 0, 0]
line = np.argmax(np.abs(np.fft.rfft(values)))
print('of 900 Hz:', line, 'Hz, amplitude', np.abs(values).max(), 'rate of the record', record.sampling_rate)
assert values.size == 1000 and line == 100 and np.abs(values).max() > 0.95
assert abs(record.sampling_rate - 1000.0) < 1e-6
PYTHON

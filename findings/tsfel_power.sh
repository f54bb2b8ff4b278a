#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# tsfel 0.2.0: a vibration of 2 g has the same greatest power as one of 1 g, and 50 Hz a median frequency of 188 Hz.
#
# A vibration at 50 Hz has an amplitude of 1 g and 2 % of its power in noise, at 1000 Hz for 2 s. Expected: an average
# power of 0.5 g², four times the greatest density of power for 2 g, and a median frequency of 50 Hz, which halves the
# power. What happens: average_power() is 500, and 1000 at 2000 Hz, as the sum of the squares is divided by the time
# instead of the number of samples. max_power_spectrum(), the "maximum power spectrum density of the signal", divides
# the signal by its standard deviation first, so that it does not depend on the amplitude. median_frequency() halves
# the sum of the amplitudes instead, so that it is 188 Hz in 2 s and 239 Hz in 50 s, as noise counts the more the longer
# the record is. spectral_centroid() weighs amplitudes too, as is usual for sound. rms() is right.
# For us: compute powers and frequencies from scipy.signal.welch().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check tsfel==0.2.0 numpy==2.4.6 scipy==1.17.1
timeout 120 "$folder/venv/bin/python" -W ignore - <<'PYTHON'
import numpy as np
import tsfel


def vibration(rate=1000, seconds=2, amplitude=1.0, noise=0.0):
    times = np.arange(rate * seconds) / rate
    return amplitude * np.sin(2 * np.pi * 50 * times) + noise * np.random.default_rng(0).normal(size=len(times))


powers = [tsfel.max_power_spectrum(vibration(amplitude=amplitude), 1000) for amplitude in (1.0, 2.0)]
print('greatest density of power of 1 g and 2 g', powers)
assert abs(powers[1] / powers[0] - 1) < 1e-6
averages = [tsfel.average_power(vibration(rate), rate) for rate in (1000, 2000)]
print('average power at 1000 and 2000 Hz', averages, 'right', np.mean(vibration() ** 2))
assert abs(np.mean(vibration() ** 2) - 0.5) < 1e-6 and abs(tsfel.rms(vibration()) ** 2 - 0.5) < 1e-6
assert abs(averages[0] - 500) < 1 and abs(averages[1] - 1000) < 1
for seconds, median in ((2, 187.5), (50, 238.7)):
    noisy = vibration(seconds=seconds, noise=0.1)
    found = tsfel.median_frequency(noisy, 1000)
    power = np.abs(np.fft.rfft(noisy)) ** 2
    right = np.fft.rfftfreq(len(noisy), 1e-3)[np.searchsorted(np.cumsum(power), power.sum() / 2)]
    print(seconds, 's: median frequency', found, 'median of the power', right)
    assert abs(right - 50) < 1e-6 and abs(found - median) < 1
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# FLife 2.3: a shaft whose torque swings at 0.5 Hz is given over 100 times its life if it is recorded at 2 kHz.
#
# Expected of SpectralData({'time_history': torque, 'dt': 1 / 2000}) of 600 s of a torque of 100 N·m RMS at 0.4 to 0.6
# Hz: a spectrum with these 100 N·m, and by Narrowband, Dirlik or TovoBenasciutti about the life that Rainflow counts in
# the same record, as for one of 100 Hz, where they are within 30 % of it. What happens: the spectrum is that of
# segments of 1280 samples, the default, here of 0.64 s, each without its mean. It has 30 N·m: the shaft is
# given more than 100 times its life; at 1 kHz about seven times. No warning.
# A sine of an amplitude of 100 N·m that is given as 'amplitude_spectrum' has an RMS of 100 N·m instead of 71. For a
# torque that swings at 200 Hz and a little at 20 Hz, of which Rainflow counts 26 s, Low's method gives -21 s.
# For us: let a segment, nperseg, last for ten swings, and compare the root of moments[0] with the RMS of the record.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --no-compile --disable-pip-version-check \
    numpy==2.4.6 scipy==1.17.1 fatpack==0.7.8 rainflow==3.2.0
"$folder/venv/bin/pip" install --quiet --no-compile --disable-pip-version-check --no-deps FLife==2.3
timeout 120 "$folder/venv/bin/python" -W error - <<'PYTHON'
import numpy as np
from FLife import Dirlik, Low, Narrowband, Rainflow, SpectralData, TovoBenasciutti

SLOPE = {'k': 5, 'C': 1e15}
random = np.random.default_rng(1)


def torque(bands, rate, duration):
    """A Gaussian torque with the given RMS in each band of frequencies."""
    frequencies = np.fft.rfftfreq(rate * duration, 1 / rate)
    parts = [np.where((frequencies > low) & (frequencies < high), 1.0, 0.0) for low, high, _ in bands]
    power = sum(part / part.sum() * rms**2 for part, (_, _, rms) in zip(parts, bands))
    turned = np.sqrt(power) * np.exp(2j * np.pi * random.random(len(frequencies)))
    return np.fft.irfft(turned, rate * duration) * rate * duration / 2**0.5


def lives(record, rate, *methods):
    """The RMS of the spectrum, and the life by each method as a multiple of the counted one, which comes last."""
    data = SpectralData({'time_history': record, 'dt': 1 / rate})
    counted = Rainflow(data).get_life(**SLOPE, algorithm='four-point', nr_load_classes=1024)
    return data.moments[0] ** 0.5, [method(data).get_life(**SLOPE) / counted for method in methods], counted


for rate, seen, least, most in ((100, 100, 0.7, 1.3), (1000, 64, 6, 8), (2000, 30, 100, 200)):
    record = torque([(0.4, 0.6, 100)], rate, 600)
    rms, ratios, _ = lives(record, rate, Narrowband, Dirlik, TovoBenasciutti)
    print(f'{rate} Hz: RMS {record.std():.1f}, of the spectrum {rms:.1f}, lives', np.round(ratios, 2))
    assert np.isclose(record.std(), 100) and np.isclose(rms, seen, atol=2)
    assert all(least < ratio < most for ratio in ratios)

_, ratios, counted = lives(torque([(18, 22, 20), (190, 210, 100)], 4000, 300), 4000, Dirlik, Low)
print(f'two bands: {counted:.1f} s counted, Dirlik {ratios[0] * counted:.1f} s, Low {ratios[1] * counted:.1f} s')
assert 0.9 < ratios[0] < 1.1 and ratios[1] < 0

frequencies = np.arange(0, 100, 0.5)
sine = SpectralData({'amplitude_spectrum': np.where(frequencies == 20, 100.0, 0.0), 'f': frequencies})
print('RMS of a sine of 100 N·m', sine.moments[0] ** 0.5)
assert np.isclose(sine.moments[0] ** 0.5, 100)
PYTHON

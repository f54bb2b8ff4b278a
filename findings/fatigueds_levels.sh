#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# FatigueDS 0.3.1: a sine sweep of 10 m/s² that is given in two parts does twice or six times its damage, and a random
# vibration given at frequencies that are not evenly spaced 2 % of it.
#
# A bracket of an actuator is swept from 20 to 500 Hz at 10 m/s². Expected of set_sine_sweep_load() and get_fds(): the
# damage of [10, 10] m/s² in the ranges [20, 100, 500] Hz is that of [10] m/s² in [20, 500] Hz, as it is the same sweep.
# What happens at 1 octave a minute: twice the damage at all natural frequencies; at 100 Hz a minute six times below 100
# Hz and 1.2 times above. The time of the whole sweep is taken for each part, which is a half of it in octaves, or 80
# and 400 of 480 Hz. Expected of set_random_load() with a density of 1 (m/s²)²/Hz from 20 to 2000 Hz: the same damage,
# whether it is given at each hertz or at 200 frequencies in a geometric series, and a greatest acceleration at 100 Hz
# near 200 m/s², by Miles' equation: sqrt(pi/2 · f · Q · density) · sqrt(2 · ln(f · T)) for an hour. What happens: 93
# m/s² and 2 % of the damage with the 200 frequencies, as each of them counts for the first interval. With the four
# frequencies 20, 80, 350 and 2000 Hz, as a test specification has them, 300 Hz get two fifths of their acceleration.
# For us: give each level of a sweep alone and add the damages; interpolate a density to evenly spaced frequencies
# first.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check FatigueDS==0.3.1 numpy==2.4.6 scipy==1.17.1
cd "$folder"
export MPLBACKEND=Agg
timeout 120 venv/bin/python - <<'PYTHON'
import numpy as np
from FatigueDS import Spectrum


def swept(levels, ranges, kind, rate):
    spectrum = Spectrum(freq_data=(50, 400, 50), Q=10)
    spectrum.set_sine_sweep_load(
        const_amp=levels, const_f_range=ranges, exc_type='acc', dt=0.01, sweep_type=kind, sweep_rate=rate
    )
    spectrum.get_fds(k=5, C=1, p=1)
    return spectrum.fds


for kind, rate in (('log', 1), ('lin', 100)):
    times = swept([10, 10], [20, 100, 500], kind, rate) / swept([10], [20, 500], kind, rate)
    print(kind, 'damage at 50 to 400 Hz in two parts over that in one', times.round(3))
    below, above = (2, 2) if kind == 'log' else (6, 1.2)
    assert abs(times[0] - below) < 0.01 and np.allclose(times[3:], above, atol=0.01)


def shaken(frequencies):
    spectrum = Spectrum(freq_data=(50, 1000, 50), Q=10)
    spectrum.set_random_load((np.ones(len(frequencies)), np.array(frequencies, dtype=float)), T=3600, unit='ms2')
    spectrum.get_ers()
    spectrum.get_fds(k=5, C=1, p=1)
    return dict(zip(spectrum.f0_range, zip(spectrum.ers, spectrum.fds)))


even, octaves, corners = shaken(np.arange(20, 2001)), shaken(np.geomspace(20, 2000, 200)), shaken([20, 80, 350, 2000])
miles = np.sqrt(np.pi / 2 * 100 * 10) * np.sqrt(2 * np.log(100 * 3600))
damage = octaves[100][1] / even[100][1]
print('at 100 Hz', miles, 'm/s² by Miles,', even[100][0], 'evenly,', octaves[100][0], 'geometric; damage', damage)
assert abs(miles - 200.4) < 0.1
assert abs(even[100][0] / miles - 1) < 0.02 and octaves[100][0] / even[100][0] < 0.5 and 0.015 < damage < 0.025
part = corners[300][0] / even[300][0]
print('at 300 Hz by 20, 80, 350 and 2000 Hz', part, 'of the acceleration')
assert abs(part - 0.39) < 0.02
PYTHON

#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# PathSim 0.27.1: a triangle of ±1 goes from -1 to 0, a chirp from 1 Hz begins at 10 Hz, and a speed is 57 % too small.
#
# Expected of TriangleWaveSource(amplitude=1): -1 to 1, as of its sine and its square wave. What happens: -1 to 0, with
# a mean of -0.5. A chirp with the "start frequency" f0 = 1 Hz and a bandwidth of 9 Hz begins at 10 Hz, falls to 1 Hz
# and rises again. Differentiator(f_max=300) is documented to hold for signals "up to a frequency of approximately
# f_max", with f_max = 1e3 as a "cutoff at 1kHz" and 3 times the highest signal frequency as a practical choice. What
# happens: of an angle that vibrates at 100 Hz it gives 43 % of the speed, 64° late, as f_max is in rad/s, as in the
# formula s / (1 + s / f_max), not in Hz as the corner of a Butterworth filter of the same library. PID has the same
# f_max. There is no warning.
# For us: give f_max in rad/s, make a triangle of amplitude 2 and add 1, and check where a chirp begins.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pathsim==0.27.1 numpy==2.4.6 scipy==1.17.1
timeout 200 "$folder/venv/bin/python" -W error - <<'PYTHON'
import math

import numpy as np
from pathsim import Connection, Simulation
from pathsim.blocks import (
    PID,
    ButterworthLowpassFilter,
    ChirpPhaseNoiseSource,
    Differentiator,
    Scope,
    SinusoidalSource,
    SquareWaveSource,
    TriangleWaveSource,
)
from pathsim.solvers import RKCK54


def recorded(duration, step, *blocks):
    scope = Scope()
    chain = [*blocks, scope]
    pairs = zip(chain[:-1], chain[1:], strict=True)
    simulation = Simulation(chain, [Connection(*pair) for pair in pairs], dt=step, Solver=RKCK54, log=False)
    simulation.run(duration)
    times, (values,) = scope.read()
    return times, values


for source, low, high in ((SinusoidalSource, -1, 1), (SquareWaveSource, -1, 1), (TriangleWaveSource, -1, 0)):
    _, values = recorded(3, 0.01, source(frequency=1, amplitude=1))
    print(source.__name__, 'of ±1: from', values.min(), 'to', values.max())
    assert abs(values.min() - low) < 0.02 and abs(values.max() - high) < 0.02

times, values = recorded(20, 0.002, ChirpPhaseNoiseSource(f0=1, BW=9, T=20, sig_cum=0, sig_white=0))
rising = times[np.flatnonzero(np.diff(np.sign(values)) > 0)]
frequencies = 1 / np.diff(rising)
middle = np.argmin(np.abs(rising[:-1] - 10))
print('chirp: begins at', frequencies[0], 'Hz, is at', frequencies[middle], 'Hz in the middle, ends at', frequencies[-1])
assert frequencies[0] > 9.5 and frequencies[middle] < 2 and frequencies[-1] > 9.5


def response(block):
    """Return amplitude and phase of a block's answer to a vibration of 1 rad at 100 Hz."""
    times, values = recorded(0.1, 5e-5, SinusoidalSource(frequency=100, amplitude=1.0), block)
    settled, angle = times > 0.05, 2 * math.pi * 100 * times
    waves = np.column_stack((np.cos(angle), np.sin(angle)))[settled]
    cosine, sine = np.linalg.lstsq(waves, values[settled], rcond=None)[0]
    return math.hypot(cosine, sine), math.degrees(math.atan2(cosine, sine))


for name, block in (('Differentiator', Differentiator(f_max=300)), ('PID', PID(Kd=1, f_max=300))):
    amplitude, phase = response(block)
    part = amplitude / (2 * math.pi * 100)
    print(f'{name}(f_max=300): {part:.3f} of the speed, {90 - phase:.1f}° late')
    assert abs(part - 0.431) < 0.005 and abs(90 - phase - 64.5) < 1
amplitude, phase = response(ButterworthLowpassFilter(Fc=100, n=1))
print('low-pass with Fc=100:', amplitude, 'at', phase, '°')
assert abs(amplitude - math.sqrt(0.5)) < 0.005
PYTHON

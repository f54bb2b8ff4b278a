#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# PyTrinamic 0.2.26: a low-pass with a quality factor of 2 has a gain of 0.25 at its corner instead of 2, and one of
# first order rings on and on.
#
# calculate_biquad_filter_coefficients() is for a TMC9660 or TMC4671. Expected of LowPassFilterSpec(500, q=2), whose q
# is a quality factor: a gain of 2 at 500 Hz. What happens: it is taken as the damping, so that the gain is 0.25, and
# q=0.5, which is critical damping, has a peak of 1.15. At q=0.7071 both are the same. Without q, the filter of first
# order has a second pole at -1, since both sides are multiplied by 1 + 1/z: switched on while its input is at 1, it
# swings between two values from one sample to the next, by as much after 10 s as at first. The test of stability looks
# at the greater pole alone and passes it, but it refuses a low-pass of 50 Hz at 25 kHz, whose pole of 0.9875 is stable,
# as unstable.
# For us: give 1 / (2 q) as q, and for a first order two equal poles (q=1), or scipy.signal.bilinear.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check PyTrinamic==0.2.26 numpy==2.4.6
cd "$folder"
timeout 100 "$folder/venv/bin/python" - <<'PYTHON'
import cmath

import numpy as np
from pytrinamic.tools.biquad_filter_calc import LowPassFilterSpec, calculate_biquad_filter_coefficients

RATE, CORNER = 25000, 500


def coefficients(*spec):
    return calculate_biquad_filter_coefficients('TMC9660', LowPassFilterSpec(*spec)).real_coefficients


def gain(filtered, frequency):
    back = cmath.exp(-2j * cmath.pi * frequency / RATE)
    return abs((filtered.b_0 + filtered.b_1 * back + filtered.b_2 * back**2) / (1 + filtered.a_1 * back + filtered.a_2 * back**2))


gains = {q: (gain(coefficients(CORNER, q), CORNER), max(gain(coefficients(CORNER, q), f) for f in range(10, 1000, 10))) for q in (0.5, 0.7071, 2.0)}
print('quality factor: gain at the corner, greatest gain', gains)
assert abs(gains[2.0][0] - 0.25) < 0.002 and abs(gains[0.7071][0] - 0.7071) < 0.002 and abs(gains[0.5][1] - 1.155) < 0.005

first = coefficients(CORNER)
poles = sorted(np.roots([1, first.a_1, first.a_2]).real)
one, two = 0.0, 0.0
swing = []
for _ in range(10 * RATE):
    now = first.b_0 + first.b_1 + first.b_2 - first.a_1 * one - first.a_2 * two
    swing.append(abs(now - one))
    one, two = now, one
print('poles of the first order', poles, 'swing after 0.1 s', swing[RATE // 10], 'and after 10 s', swing[-1])
assert abs(poles[0] + 1) < 1e-9 and abs(poles[1] - 0.88) < 0.01
assert swing[-1] > 0.05 and abs(swing[-1] - swing[RATE // 10]) < 1e-6
try:
    coefficients(50)
except AttributeError as error:
    print('50 Hz, pole', (1 - cmath.pi * 50 / RATE) / (1 + cmath.pi * 50 / RATE), error)
else:
    raise SystemExit(1)
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# lenz-flashtool 0.2.0: an encoder at 45° that is compensated by a table of zeros is at 0°, one at 200° is at 20°.
#
# LenzEncoderProcessor takes the counts of a 24-bit encoder as int32 and a coarse factor, "typically 2^11 for 24-bit
# encoders" by its documentation, whose example has 2048. Expected of comp_diff() with a table of zeros: the same
# counts, and of lenz_cal() the error of the encoder all around. What happens: the product of counts and factor
# overflows 32 bits from a factor of 256 on. With 2048, angles from 22.5° to 337.5° come out wrong. With 256, lenz_cal()
# finds an error of 60 in the first half turn and none in the second; with 128 it finds it in both. No exception and no
# warning tells it.
# For us: give comp_diff() 64-bit counts; lenz_cal() makes 32 bits of them, so calibrate with a factor of up to 128.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check lenz-flashtool==0.2.0 numpy==2.4.6 colorama==0.4.6
timeout 120 "$folder/venv/bin/python" - <<'PYTHON'
import warnings

import numpy as np
from lenz_flashtool.encproc import LenzEncoderProcessor

COUNTS = 2**24
AMPLITUDE = 60
warnings.simplefilter('error', RuntimeWarning)
angles = np.array([10, 45, 90, 200])
counts = np.int32(angles / 360 * COUNTS)


def compensated(counts, factor):
    zeros = np.zeros(factor * 256 + 1, np.int16)
    return np.round(LenzEncoderProcessor.comp_diff(counts, zeros, factor) / COUNTS * 360, 3).tolist()


def amplitudes(factor):
    """The amplitude that is found in each half turn, of an error of 60 with `factor` periods in a turn."""
    turns = np.linspace(0, 2.5, 40_000)
    error = AMPLITUDE * 2**11 / factor * np.sin(2 * np.pi * factor * turns)
    measured = np.int32(np.floor(turns * COUNTS + error).astype(np.int64) & (COUNTS - 1))
    table = LenzEncoderProcessor.lenz_cal(measured, factor).reshape(2, -1)
    wave = -np.sin(2 * np.pi * np.arange(table.shape[1]) / 256)
    return (table @ wave / (wave @ wave)).tolist()


at_2048, in_64_bits, at_64 = compensated(counts, 2048), compensated(counts.astype(np.int64), 2048), compensated(counts, 64)
print(angles.tolist(), 'deg with the factor 2048:', at_2048, 'with 64-bit counts:', in_64_bits, 'with the factor 64:', at_64)
assert in_64_bits == at_64 == angles.tolist()
assert at_2048 == [10, 0, 0, 20]
right, wrong = amplitudes(128), amplitudes(256)
print('amplitudes in both half turns, factor 128:', np.round(right, 1).tolist(), 'factor 256:', np.round(wrong, 1).tolist())
assert np.allclose(right, AMPLITUDE, atol=1)
assert np.allclose(wrong, [AMPLITUDE, 0], atol=1)
PYTHON

#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# RigolWFM 1.6.0: of a Tektronix .isf with 1000 samples the last 600 are lost if they are 10 counts.
#
# `Wfm.from_file()` reads the .isf files of Tektronix oscilloscopes. Expected of a record of 1000 samples of one byte,
# as an index track that falls from 4 V to 0.4 V: 1000 samples. What happens: a line feed that may stand behind the
# samples is cut off together with all bytes before it that are 10 or 13, which are samples here. NR_PT and the length
# before the samples, which both say 1000, are not compared with what is left, and nothing warns.
# Expected of the other forms of samples that the manuals of these oscilloscopes list: positive integers (BN_FMT RP),
# and floating point numbers of 4 bytes (FP), as of a waveform that the oscilloscope has calculated. What happens:
# BN_FMT is not looked at. Above half of the range RP is read as negative, and the halves of FP are read as integers.
# Output: RI, last samples at 9 counts: 1000 samples, the last at 0.999 s with 0.36 V
#         RI, last samples at 10 counts: 400 samples, the last at 0.399 s with 4.00 V
#         RP, 250 counts: -0.24 V instead of 10.00 V
#         FP, 1.5 V: 16320 V and 0 V in turn
# For us: save as signed integers of two bytes, and compare the number of samples with NR_PT in the header of the file.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check rigolwfm==1.6.0 kaitaistruct==0.11 numpy==2.4.6 \
    matplotlib==3.11.2
cd "$folder"
timeout 120 "$folder/venv/bin/python" - <<'PYTHON'
from pathlib import Path

import numpy as np
from RigolWFM.wfm import Wfm


def read(kind, samples, volts_per_count=0.04):
    """Write the samples as an .isf with one line feed behind them and return the times and voltages that are read."""
    fields = {'BYT_NR': samples.itemsize, 'BIT_NR': 8 * samples.itemsize, 'ENCDG': 'BIN', 'BN_FMT': kind,
              'BYT_OR': 'MSB', 'NR_PT': len(samples), 'WFID': '"Ch1, DC coupling, 1.0E0 V/div"', 'PT_FMT': 'Y',
              'XINCR': '1.0E-3', 'PT_OFF': 0, 'XZERO': '0.0E0', 'XUNIT': '"s"', 'YMULT': volts_per_count,
              'YZERO': '0.0E0', 'YOFF': '0.0E0', 'YUNIT': '"V"'}
    header = ':WFMPRE:' + ';'.join(f'{key} {value}' for key, value in fields.items())
    length = str(samples.nbytes)
    Path('record.isf').write_bytes(f'{header};:CURVE #{len(length)}{length}'.encode() + samples.tobytes() + b'\n')
    channel = Wfm.from_file('record.isf').channels[0]
    return channel.times, channel.volts


for counts, number, last in ((9, 1000, 0.36), (10, 400, 4.0)):
    times, volts = read('RI', np.where(np.arange(1000) < 400, 100, counts).astype('i1'))
    print(f'RI, last samples at {counts} counts: {len(volts)} samples,',
          f'the last at {times[-1]:.3f} s with {volts[-1]:.2f} V')
    assert len(times) == len(volts) == number and abs(volts[-1] - last) < 1e-5

_, volts = read('RP', np.full(1000, 250, 'u1'))
print(f'RP, 250 counts: {volts[0]:.2f} V instead of {250 * 0.04:.2f} V')
assert len(volts) == 1000 and np.allclose(volts, (250 - 256) * 0.04)

_, volts = read('FP', np.full(1000, 1.5, '>f4'), volts_per_count=1.0)
print(f'FP, 1.5 V: {volts[0]:.0f} V and {volts[1]:.0f} V in turn')
assert len(volts) == 1000 and set(volts) == {16320.0, 0.0}
PYTHON

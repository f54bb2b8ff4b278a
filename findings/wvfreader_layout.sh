#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# wvfreader 0.1.2: half of a rotor's angles are those of the output, in a Yokogawa recording stored block by block.
#
# A recording of a Yokogawa ScopeCorder is a .WVF file with its .HDR header. By the manuals of these instruments, the
# entry DataFormat says whether the samples are stored trace by trace (Trace) or block by block (Block), BlockSize and
# VDataType are given for each trace, and a sample that is equal to VIllegalData is not valid. Expected of each channel:
# its own samples. What happens: DataFormat is not looked at, and the place of a trace is found as if all the traces
# before it had its own block size and data type. So for Block, and for an output at a quarter of the rotor's rate or
# with another data type behind it, samples of the rotor are given as those of the output. Nothing warns.
# VIllegalData is not looked at either: a sample that is not valid is an angle of -32.768 rad.
# Output: Trace, 2 blocks: rotor 0 1 2 3 4 5 6 7, output 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8
#         Block, 2 blocks: rotor 0 1 2 3 0.1 0.2 0.3 0.4, output 4 5 6 7 0.5 0.6 0.7 0.8
#         two rates: rotor 0 1 2 3 4 5 6 7, output 2 3
#         invalid sample: rotor 1 -32.768 3
# For us: save in the layout Trace, with one rate and one data type for all channels, and drop the illegal value.
#
# Exit code 0: still so. Installs the version into a temporary folder; Python needs its module tkinter.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps wvfreader==0.1.2 numpy==2.4.6
cd "$folder"
timeout 120 "$folder/venv/bin/python" - <<'PYTHON'
from pathlib import Path

import numpy as np
import wvfreader

PER_TRACE = {'VResolution': '1.0E-03', 'VOffset': '0.0E+00', 'VDataType': 'IS2', 'VUnit': 'rad', 'VIllegalData': -32768,
             'HResolution': '1.0E-03', 'HOffset': '0.0E+00', 'HUnit': 's', 'Date': '2026/11/30', 'Time': '12:00:00.00'}


def saved(name, layout, traces):
    """Write each trace, an array of one row a block, in mrad and return what the package reads, in rad."""
    blocks = len(next(iter(traces.values())))
    lines = ['//YOKOGAWA ASCII FILE FORMAT', '', '$PublicInfo', 'FormatVersion 1.11', 'Model DL750', 'Endian Ltl',
             f'DataFormat {layout}', 'GroupNumber 1', f'TraceTotalNumber {len(traces)}', 'DataOffset 0', '', '$Group1',
             f'TraceNumber {len(traces)}', f'BlockNumber {blocks}', 'TraceName ' + ' '.join(traces),
             'BlockSize ' + ' '.join(str(len(rows[0])) for rows in traces.values())]
    lines += [f'{key} ' + ' '.join([str(value)] * len(traces)) for key, value in PER_TRACE.items()]
    Path(f'{name}.HDR').write_text('\n'.join(lines) + '\n')
    parts = [(trace, block) for trace in traces for block in range(blocks)]
    if layout == 'Block':
        parts.sort(key=lambda part: part[1])
    Path(f'{name}.WVF').write_bytes(b''.join(np.array(traces[t][b], '<i2').tobytes() for t, b in parts))
    read = wvfreader.datafile(f'{name}.WVF')[0].traces
    return {trace: ' '.join(f'{value:g}' for value in read[trace].y.T.ravel()) for trace in traces}


rotor, output = np.arange(8) * 1000, np.arange(1, 9) * 100
two_blocks = {'rotor': rotor.reshape(2, 4), 'output': output.reshape(2, 4)}
right = {'rotor': '0 1 2 3 4 5 6 7', 'output': '0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8'}
expected = [
    ('Trace, 2 blocks', saved('traces', 'Trace', two_blocks), right),
    ('Block, 2 blocks', saved('blocks', 'Block', two_blocks),
     {'rotor': '0 1 2 3 0.1 0.2 0.3 0.4', 'output': '4 5 6 7 0.5 0.6 0.7 0.8'}),
    ('two rates', saved('rates', 'Trace', {'rotor': [rotor], 'output': [output[::4]]}),
     {'rotor': right['rotor'], 'output': '2 3'}),
    ('invalid sample', saved('invalid', 'Trace', {'rotor': [[1000, -32768, 3000]]}), {'rotor': '1 -32.768 3'}),
]
for case, read, seen in expected:
    print(f'{case}:', ', '.join(f'{trace} {values}' for trace, values in read.items()))
    assert read == seen, case
PYTHON

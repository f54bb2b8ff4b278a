#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# lecroyutils 4.0.2, lecroyscope 1.0.0, lecroyparser 1.4.2, wfm-oxide 0.4.1: the times of a .trc are stretched, triggers
# 1 s apart are 2.5 ms apart, or the bytes of its samples are exchanged.
#
# A .trc by LeCroy's template LECROY_2_3, with the signal of an encoder: four triggers, one a second, of 25 samples in
# steps of 0.1 ms. Expected: samples 0.1 ms apart, and each trigger at its own time. What happens: lecroyutils and
# lecroyparser spread n samples over n steps instead of n-1, so that all speeds are 1/n too small, 4 % for 25 samples.
# wfm-oxide and lecroyparser put the triggers one behind the other as a single record of 10 ms: what happened a second
# apart is 2.5 ms apart. lecroyscope gives the times right, but in a file whose bytes are in the order HIFIRST, which
# the template allows as well, it exchanges the bytes of each 16-bit sample: -5.0 V are 30.956 V. Its documented file
# name with the trace number 00000, which is the first one that an oscilloscope saves, is an error. No warnings.
# For us: take the step from the header (horizontal_interval), and the trigger times from lecroyutils.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    lecroyutils==4.0.2 lecroyscope==1.0.0 lecroyparser==1.4.2 wfm-oxide==0.4.1 numpy==2.4.6
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import struct

import lecroyparser
import numpy as np
from lecroyscope import Trace
from lecroyutils.data import LecroyScopeData
from wfm_oxide import WfmOxide

STEP, SEGMENTS, SAMPLES = 1e-4, 4, 25
counts = np.arange(-50, 50) * 100  # gain 1e-3: -5.0 to 4.9 V
FIELDS = [
    # offset of the field in the descriptor, its format, its value
    (32, 'h', 1), (36, 'i', 346), (48, 'i', 16 * SEGMENTS), (60, 'i', 2 * counts.size),
    (116, 'i', counts.size), (120, 'i', counts.size), (128, 'i', counts.size - 1), (136, 'i', 1),
    (144, 'i', SEGMENTS), (148, 'i', 1), (156, 'f', 1e-3), (164, 'f', 32752.0), (168, 'f', -32752.0),
    (172, 'h', 12), (174, 'h', SEGMENTS), (176, 'f', STEP), (296, 'd', 7.25), (308, 'h', 2026),
    (324, 'h', 30), (326, 'h', 2), (328, 'f', 1.0), (332, 'h', 15), (336, 'f', 1.0),
]


def write(name, order):
    descriptor = bytearray(346)
    for offset, text in ((0, b'WAVEDESC'), (16, b'LECROY_2_3'), (76, b'LECROYHDO'), (196, b'V'), (244, b'S')):
        descriptor[offset : offset + len(text)] = text
    descriptor[304:308] = bytes([30, 12, 28, 11])  # minute, hour, day, month
    for offset, kind, value in [*FIELDS, (34, 'h', 0 if order == '>' else 1)]:
        struct.pack_into(order + kind, descriptor, offset, value)
    triggers = np.array([[second, 0.0] for second in range(SEGMENTS)], order + 'f8')
    content = bytes(descriptor) + triggers.tobytes() + counts.astype(order + 'i2').tobytes()
    with open(name, 'wb') as file:
        file.write(b'#9%09d' % len(content) + content)


write('C1Trace00001.trc', '<')
utils, scope = LecroyScopeData.parse_file('C1Trace00001.trc'), Trace('C1Trace00001.trc')
parser, oxide = lecroyparser.ScopeData('C1Trace00001.trc'), WfmOxide('C1Trace00001.trc')
steps = [np.diff(times)[0] for times in (utils.x[:, 0], parser.x, oxide.get_time_axis(), scope.time)]
print('steps of lecroyutils, lecroyparser, wfm-oxide and lecroyscope:', steps)
assert np.allclose(steps, [STEP * 25 / 24, STEP * 100 / 99, STEP, STEP])
print('last times', utils.x.max(), parser.x.max(), oxide.get_time_axis().max())
assert utils.x[0].tolist() == [0.0, 1.0, 2.0, 3.0]
assert np.allclose([parser.x.max(), oxide.get_time_axis().max()], [0.01, 0.0099])
assert np.allclose(scope.voltage.ravel(), counts * 1e-3) and np.allclose(utils.y[:, 0], counts[:SAMPLES] * 1e-3)

write('C1Trace00002.trc', '>')
swapped, right = Trace('C1Trace00002.trc').voltage, LecroyScopeData.parse_file('C1Trace00002.trc').y
print('first sample of a file in the order HIFIRST:', swapped[0, 0], right[0, 0])
assert np.allclose([swapped[0, 0], right[0, 0]], [30.956, -5.0])

write('C1Trace00000.trc', '<')
try:
    Trace('C1Trace00000.trc')
except ValueError as error:
    print('C1Trace00000.trc:', error)
else:
    raise SystemExit(1)
PYTHON

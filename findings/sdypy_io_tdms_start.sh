#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# sdypy-io-tdms 0.1.2: a TDMS that began at 0.9 s is read as from 0 s, and an angle is written with 32 bits.
#
# A file of an encoder of 1 kHz whose wf_start_time is 04:00:00.9, and whose first sample comes 0.25 s later by
# wf_start_offset. Expected of read_tdms(): a start at 04:00:01.15. What happens: the start is cut to whole seconds
# and the offset is left out, so that it is at 04:00:00, and two files of one motor can lie against each other by up
# to a second. write_tdms() makes each number one of 32 bits, so that a rotor after 196 turns has steps of 0.12 mrad
# and a count of 16777217 is 16777216, and it writes no start at all. None of it with a warning.
# For us: read such files with npTDMS, as gearkin does, and write numbers of 64 bits and the start with its
# TdmsWriter.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    sdypy_io_tdms==0.1.2 npTDMS==1.13.0 numpy==2.4.6
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import numpy as np
from nptdms import ChannelObject, TdmsFile, TdmsWriter
from sdypy_io_tdms.tdms import read_tdms, write_tdms

angles = np.array([1234.56789, 1234.56795])
properties = {
    'wf_start_time': np.datetime64('2026-11-28T04:00:00.900000'),
    'wf_start_offset': 0.25,
    'wf_increment': 0.001,
    'unit_string': 'rad',
}
with TdmsWriter('motor.tdms') as writer:
    writer.write_segment([ChannelObject('motor', 'rotor', angles, properties)])
channel = TdmsFile('motor.tdms')['motor']['rotor']
print('npTDMS', channel[:], channel.time_track(absolute_time=True, accuracy='us')[0])
assert channel[:].tolist() == angles.tolist()
assert channel.time_track(absolute_time=True, accuracy='us')[0] == np.datetime64('2026-11-28T04:00:01.150000')

[signal] = read_tdms('motor.tdms')
print('read', signal)
assert signal['start_timestamp'] == '2026-11-28T04:00:00'

counts = dict(signal, name='counts', data=np.array([16777216, 16777217]))
write_tdms([signal, counts], 'written.tdms')
written = {signal['name']: signal for signal in read_tdms('written.tdms')}
print('written', written)
assert np.abs(written['rotor']['data'] - angles).max() > 1e-5
assert written['counts']['data'].tolist() == [16777216, 16777216]
assert 'start_timestamp' not in written['rotor']
PYTHON

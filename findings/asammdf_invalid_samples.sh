#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# asammdf 8.8.28: a sample that is marked as invalid comes back in select(), iter_channels(), an MDF 3, and .mat and
# .hdf files.
#
# A shaft was recorded five times, and the encoder has marked the third reading, of 99 rad, as invalid. Expected: four
# samples, or a mark, everywhere. What happens: get() gives four; select() and iter_channels() give 99 rad with the bits
# beside it; convert() to MDF 3, which has no such bits, and export() to .mat and .hdf write 99 rad as any other sample,
# without a warning. to_dataframe() and a .csv have 0.2 rad there, between its neighbours. mdfreader 4.3 reads 99 rad,
# too.
# For us: gearkin leaves such samples out of an .mf4; otherwise call validate() of each channel before it is used or
# written.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check asammdf==8.8.28 mdfreader==4.3 scipy==1.17.1 h5py==3.16.0
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import h5py
import mdfreader
import numpy as np
import scipy.io
from asammdf import MDF, Signal

RECORDED, VALID = [0.0, 0.1, 99.0, 0.3, 0.4], [0.0, 0.1, 0.3, 0.4]
invalid = np.arange(5) == 2
with MDF(version='4.10') as file:
    file.append([Signal(np.array(RECORDED), np.arange(5) / 10, name='shaft', invalidation_bits=invalid)])
    file.save('shaft.mf4')

read = {'mdfreader': mdfreader.Mdf('shaft.mf4').get_channel_data('shaft')}
with MDF('shaft.mf4') as file:
    read['get'] = file.get('shaft').samples
    read['validate'] = next(iter(file.iter_channels(skip_master=True))).validate().samples
    read['select'] = file.select(['shaft'])[0].samples
    read['iter_channels'] = next(iter(file.iter_channels(skip_master=True))).samples
    read['convert'] = file.convert('3.30').get('shaft').samples
    read['to_dataframe'] = file.to_dataframe()['shaft']
    file.export('mat', 'shaft.mat')
    file.export('hdf5', 'shaft.hdf')
read['mat'] = scipy.io.loadmat('shaft.mat')['DG0_shaft'].ravel()
with h5py.File('shaft.hdf') as file:
    read['hdf5'] = file['ChannelGroup_0/shaft'][()]
for how, samples in read.items():
    print(how, np.round(samples, 9).tolist())
    expected = {'get': VALID, 'validate': VALID, 'to_dataframe': [0.0, 0.1, 0.2, 0.3, 0.4]}
    assert np.allclose(samples, expected.get(how, RECORDED))
PYTHON

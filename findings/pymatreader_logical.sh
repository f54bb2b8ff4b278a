#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pymatreader 1.3.2: positions[valid] of a .mat, where `valid` is a logical array, are the first two positions again and
# again.
#
# Expected of a logical array of MATLAB: an array of bool, so that positions[valid] are the valid positions, as in
# MATLAB. What happens: it is an array of uint8, of version 5 and of version 7.3, with which numpy takes the positions
# number 0 and 1. Of six positions from 0 to 0.5 rad, of which four are valid, there are six, all 0 or 0.1 rad, with a
# mean of 0.07 rad instead of 0.225 rad, without an error. ~valid is 254 and 255. read_mat() has no argument to change
# it. mat73 0.65 reads version 7.3 with bool; SciPy reads version 5 with bool if it is told mat_dtype=True.
# For us: write `valid.astype(bool)` wherever a logical array of a .mat selects samples.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    pymatreader==1.3.2 mat73==0.65 scipy==1.17.1 h5py==3.16.0 numpy==2.4.6
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import h5py
import mat73
import numpy as np
import scipy.io
from pymatreader import read_mat

positions, valid = np.arange(6) * 0.1, np.array([True, True, False, True, False, True])
scipy.io.savemat('v5.mat', {'positions': positions, 'valid': valid})
with h5py.File('v73.mat', 'w', userblock_size=512) as file:
    file['positions'] = positions[None]
    file['positions'].attrs['MATLAB_class'] = np.bytes_('double')
    file['valid'] = valid[None].astype(np.uint8)
    file['valid'].attrs['MATLAB_class'] = np.bytes_('logical')
    file['valid'].attrs['MATLAB_int_decode'] = np.int32(1)
with open('v73.mat', 'r+b') as file:
    file.write(b'MATLAB 7.3 MAT-file'.ljust(116) + bytes(8) + b'\x00\x02IM')

right = scipy.io.loadmat('v5.mat', squeeze_me=True, mat_dtype=True), mat73.loadmat('v73.mat')
for read in right:
    assert read['valid'].dtype == bool and np.allclose(read['positions'][read['valid']], [0, 0.1, 0.3, 0.5])
for name in ('v5.mat', 'v73.mat'):
    read = read_mat(name)
    chosen = read['positions'][read['valid']]
    print(f'{name}: valid is {read["valid"].dtype} {read["valid"]}, the positions are {chosen}, their mean {chosen.mean():.3f}')
    assert read['valid'].dtype == np.uint8 and chosen.tolist() == [0.1, 0.1, 0.0, 0.1, 0.0, 0.1]
PYTHON

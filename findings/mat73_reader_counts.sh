#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mat73-reader 0.1.1: the counts of a 16-bit encoder in a .mat of MATLAB 7.3 are read as text, and an empty array of
# faults as [0, 1].
#
# A file with counts of the class uint16, flags of the class logical, and an empty array of faults. Expected, as its
# table says: numeric arrays as numpy.ndarray, only char arrays as str. What happens: the class is not read. Whatever
# has 16 unsigned bits is a text, so that 100, 200 and 300 counts are 'dÈĬ', and 65 alone is 'A'. An empty array is
# the list of its dimensions. The flags are whole numbers, so that they select the samples 1, 0 and 1 instead of the
# first and the last. No error, no warning.
# For us: write counts as int32 or double in MATLAB, or read such files with mat73, which looks at the class.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    mat73-reader==0.1.1 hdf5storage==0.2.2 h5py==3.16.0 numpy==2.4.6 mat73==0.65
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import hdf5storage
import mat73
import mat73_reader
import numpy as np

variables = {
    'counts': np.array([100, 200, 300], dtype=np.uint16),
    'home': np.uint16(65),
    'valid': np.array([True, False, True]),
    'faults': np.array([]),
    'position': np.array([0.1, 0.2, 0.3]),
}
hdf5storage.savemat('motor.mat', variables, format='7.3', oned_as='column')
read = mat73_reader.load('motor.mat')
right = mat73.loadmat('motor.mat')
print('mat73-reader', read)
print('mat73', right)
assert right['counts'].tolist() == [100, 200, 300] and right['valid'].tolist() == [True, False, True]
assert read['counts'] == 'dÈĬ' and read['home'] == 'A'
assert read['faults'].tolist() == [0, 1]
selected = read['position'].ravel()[read['valid'].ravel()]
print('position[valid]', selected)
assert selected.tolist() == [0.2, 0.1, 0.2]
PYTHON

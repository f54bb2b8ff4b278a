#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mat-for-js 1.1.0 (npm): poses of an arm in a .mat, a 4 by 4 matrix a sample, are read with their numbers mixed up.
#
# A file of MATLAB 5 with an array of 4 x 4 x 3: at each of three samples the pose of a flange, which is 0.5 m out and
# turned by 0, 0.1 and 0.2 rad. Expected: T[row][column][sample], as a matrix is m[row][column]. What happens: each
# row begins at the right number and then goes on with a wrong step, so that numbers are repeated and others are lost.
# T[0][0], the cosines 1, 0.995 and 0.98, is [1, 0, 0]; the 0.5 m of T[0][3] stand in T[0][1]. Vectors and matrices
# are right. No error.
# For us: in MATLAB, save reshape(T, 16, []), or one matrix for each sample.
#
# Exit code 0: still so. Needs node; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check scipy==1.17.1 numpy==2.4.6
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts mat-for-js@1.1.0
timeout 60 venv/bin/python - <<'PYTHON'
import numpy as np
from scipy.io import savemat

poses = np.zeros((4, 4, 3))
for sample, angle in enumerate((0.0, 0.1, 0.2)):
    cosine, sine = np.cos(angle), np.sin(angle)
    poses[:, :, sample] = [[cosine, -sine, 0, 0.5], [sine, cosine, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
savemat('arm.mat', {'T': poses, 'flat': poses.reshape(16, 3, order='F')})
PYTHON
cat > read.cjs <<'JAVASCRIPT'
const assert = require('node:assert');
const { readFileSync } = require('node:fs');
const { read } = require('mat-for-js');

const bytes = readFileSync('arm.mat');
const { T, flat } = read(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length)).data;
const round = (number) => Math.round(number * 1000) / 1000;
const right = [0, 1, 2, 3].map((row) => [0, 1, 2, 3].map((column) => flat[4 * column + row].map(round)));
const wrong = T.map((row) => row.map((samples) => samples.map(round)));
console.log('written', JSON.stringify(right));
console.log('read   ', JSON.stringify(wrong));
assert.deepEqual(right[0], [[1, 0.995, 0.98], [0, -0.1, -0.199], [0, 0, 0], [0.5, 0.5, 0.5]]);
assert.deepEqual(wrong[0], [[1, 0, 0], [0, 0, 0.5], [0, 0.5, 0.995], [0.5, 0.995, -0.1]]);
JAVASCRIPT
timeout 60 node read.cjs

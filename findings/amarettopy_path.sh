#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# amarettopy 0.1.0: a turn from 0° to 180° that begins at 100 s, instead of at 0 s, begins at -2328° and ends at -1744°.
#
# Expected of AmarettoPath([(t0, 0), (t0 + 1, 180)]), whose t0 is documented as the "time at which the motion begins":
# the same motion for each t0. What happens: the coefficients of the parts that speed up and slow down are those of
# polynomials of fifth order in the time since 0, whose terms cancel out. At 10 s the angles are off by 0.002°, at 100 s
# by 2000° and at 1000 s by 200 000°, while the part at constant speed between them stays right.
# For us: let each path begin at 0 s, and subtract the time of its beginning from that of interp().
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps \
    amarettopy==0.1.0 crc8==0.2.1 pyserial==3.5 PyYAML==6.0.3 numpy==2.3.5
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from amarettopy.path import AmarettoPath

angles = {}
for begin in (0, 10, 100, 1000):
    path = AmarettoPath([(begin, 0.0), (begin + 1, 180.0)])
    angles[begin] = [path.interp(begin + t) for t in (0, 0.1, 0.5, 0.9, 1)]
    print(f'beginning at {begin:4} s:', [round(angle, 3) for angle in angles[begin]])
right = angles[0]
assert right[0] == 0 and abs(right[2] - 90) < 1e-9 and abs(right[4] - 180) < 1e-9
off = {begin: [abs(angle - there) for angle, there in zip(angles[begin], right)] for begin in angles}
assert 1e-4 < max(off[10]) < 0.1
for begin, least in ((100, 500), (1000, 50_000)):
    assert min(off[begin][0], off[begin][1], off[begin][3], off[begin][4]) > least and off[begin][2] < 1e-6
PYTHON

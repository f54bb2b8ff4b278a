#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# isofits 1.0: a shaft of 150 f6 is given a tolerance of 5 µm instead of 25 µm, so that its largest clearance in H7 is
# 20 µm too small.
#
# By ISO 286-2 a shaft of 150 f6 is between -68 and -43 µm, f5 between -61 and -43 µm, and a hole of 350 E7 between 125
# and 182 µm, of 8 K6 between -7 and 2 µm. What happens: isotol() gives f6 from 120 to 180 mm as -48 to -43 µm, less
# than a third of the finer f5, so that isofit(150, 'H7', 'f6') is a clearance of 43 to 88 µm instead of 108 µm. E7 above
# 315 mm ends at 185 µm, and K6 from 6 to 10 mm begins at -6 µm. Nothing warns. The other shafts from d to p and holes
# from E to H, up to grade 12, are right.
# For us: compare each width with that of another letter of the same grade, which has to be equal.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check isofits==1.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from isofits import isofit, isotol


def limits(body, size, fit):
    upper, lower = isotol(body, size, fit, 'both')
    return lower, upper


found = {
    'shaft f5 at 150 mm': limits('shaft', 150, 'f5'),
    'shaft f6 at 150 mm': limits('shaft', 150, 'f6'),
    'shaft g6 at 150 mm': limits('shaft', 150, 'g6'),
    'hole E7 at 350 mm': limits('hole', 350, 'E7'),
    'hole K6 at 8 mm': limits('hole', 8, 'K6'),
    'H7/f6 at 150 mm': isofit(150, 'H7', 'f6'),
    'H7/g6 at 150 mm': isofit(150, 'H7', 'g6'),
}
for name, (least, greatest) in found.items():
    print(f'{name}: {least:g} to {greatest:g} µm, a width of {greatest - least:g} µm')
assert list(found.values()) == [(-61, -43), (-48, -43), (-39, -14), (125, 185), (-6, 2), (43, 88), (14, 79)]
PYTHON

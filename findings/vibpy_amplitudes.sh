#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# vibpy 0.0.2: a vibration of 1 g at 50 Hz has an amplitude of 0.1 mm, but of 967 km if the frequency is in a list.
#
# Expected of sin_g2amp(f, acc), "calculate amplitude(mm) based on frequency and acceleration(g)", which takes one
# frequency or a list of them: a sinusoid has the amplitude a/(2 pi f)², which for 1 g at 50 Hz is 0.0993 mm, and at 100
# Hz a fourth of this. What happens: 0.0993 mm for f=50, and for [50, 100] 967 million and 3869 million mm, as the list
# is multiplied by (2 pi f)² instead of divided. The function the other way, sin_amp2g(), is right for both, so that
# there and back makes 1 g of 0.1 mm and 967 km of 1 g.
# For us: give sin_g2amp() one whole frequency at a time, or divide by (2 pi f)² yourself.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 scipy==1.17.1 matplotlib==3.10.8
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check vibpy==0.0.2
cd "$folder"
export MPLBACKEND=Agg
timeout 60 venv/bin/python - <<'PYTHON'
import math

import vibpy

GRAVITY = 9.8
expected = [1e3 * GRAVITY / (2 * math.pi * frequency) ** 2 for frequency in (50, 100)]
single = [vibpy.sin_g2amp(frequency, 1) for frequency in (50, 100)]
several = vibpy.sin_g2amp([50, 100], 1)
print('1 g at 50 and 100 Hz: expected', expected, 'mm, one at a time', single, 'mm, as a list', several, 'mm')
assert all(abs(found - right) < 1e-9 for found, right in zip(single, expected))
assert abs(several[0] / 967e6 - 1) < 0.01 and abs(several[1] / 3869e6 - 1) < 0.01
back = vibpy.sin_amp2g([50, 100], single[0]), vibpy.sin_amp2g(50, single[0])
print('and back', back)
assert abs(back[0][0] - 1) < 1e-9 and abs(back[0][1] - 4) < 1e-9 and abs(back[1] - 1) < 1e-9
PYTHON

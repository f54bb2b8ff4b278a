#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# scinum 2.2.2: behind a gear of -19, a rotor from 360° to 420° gives an output from -21.1° to -17.9°.
#
# A rotor stands at 380°, by +40° and -20°, so between 360° and 420°, and the ratio is -19. Expected of
# Number(380, (40, 20)) / -19: -20°, by +1.05° and -2.11°, so between -22.11° and -18.95°, as 420°/-19 and 360°/-19.
# What happens: by +2.11° and -1.05°, so between -21.05° and -17.89°, as each side is multiplied by the size of the
# derivative and stays on its side. The same holds for -x, 400 - x, 1/x and ops.cos(). With the ratio 19 it is right.
# For us: divide the two ends of the interval instead.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check scinum==2.2.2 numpy==2.4.6
cat > "$folder/output.py" <<'PYTHON'
import math

import numpy as np
from scinum import DOWN, UP, Number, ops

rotor, radians = Number(380.0, (40.0, 20.0)), Number(0.5, (0.1, 0.05))
assert (rotor.get(DOWN), rotor.get(UP)) == (360, 420)
for name, number, function, argument, wrong in (
    ('x/19', rotor, lambda x: x / 19, None, False),
    ('x/-19', rotor, lambda x: x / -19, None, True),
    ('-x', rotor, lambda x: -x, None, True),
    ('400 - x', rotor, lambda x: 400 - x, None, True),
    ('1/x', rotor, lambda x: 1 / x, None, True),
    ('cos(x)', radians, ops.cos, math.cos, True),
):
    found = function(number)
    other = argument or function
    ends = sorted((other(number.get(DOWN)), other(number.get(UP))))
    print(f'{name}: {found.get(DOWN):.4f} to {found.get(UP):.4f}, by the ends {ends[0]:.4f} to {ends[1]:.4f}')
    above, below = found.get(UP) - found.nominal, found.nominal - found.get(DOWN)
    swapped = (ends[1] - found.nominal < found.nominal - ends[0]) != (above < below)
    assert swapped == wrong
seen = rotor / -19
assert np.allclose((seen.nominal, seen.get(UP), seen.get(DOWN)), (-20, -20 + 40 / 19, -20 - 20 / 19))
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/output.py"

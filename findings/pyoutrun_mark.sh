#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pyOutRun 1.0.1: a mark on a shaft that passes a sensor at 0° is found at 180°, and the next sensor 237° away, not 57°.
#
# angle_position_flanks() finds the angles of a shaft at which a mark passes several sensors. The mark passes the first
# one at 0.0 rad and the second one at 1.0 rad, in four turns with a jitter of ±2 mrad. Expected: 0.0 or 2π, and a
# distance of 1.0 rad, as it is found where the mark passes at 1.5 and 2.5 rad. What happens: 3.14 rad, and a distance
# of 4.14 rad, without a warning: it takes the median of the angles in each turn after it has wrapped them to 0 to 2π,
# and the median of 0.002, 6.281, 0.002 and 6.281 is 3.14. In an odd number of turns it is right.
# For us: turn the zero of the encoder away from the mark before.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pyOutRun==1.0.1 numpy==2.4.6 scipy==1.17.1 numba==0.68.1
cat > "$folder/mark.py" <<'PYTHON'
import math

import numpy as np
from pyOutRun import angle_position_flanks


def found(first, turns):
    angle = np.linspace(-0.5, math.tau * turns - 0.5, 5000 * turns, endpoint=False)

    def pulses(centre):
        turn = np.round((angle - centre) / math.tau).astype(int)
        jitter = 0.002 * (-1.0) ** turn
        return np.exp(-(((angle - centre - math.tau * turn - jitter) / 0.05) ** 2))

    noise = np.random.default_rng(0).normal(0, 0.01, (angle.size, 2))
    distances, offset = angle_position_flanks(angle, np.column_stack((pulses(first), pulses(first + 1))) + noise)
    return offset, distances[1]


for first, turns, right in ((0.0, 4, False), (0.0, 10, False), (0.0, 5, True), (1.5, 4, True)):
    offset, distance = found(first, turns)
    print(f'mark at {first} and {first + 1} rad in {turns} turns: found at {offset:.3f} rad, distance {distance:.3f} rad')
    off = abs(math.remainder(offset - first, math.tau))
    assert (off < 0.01) if right else (abs(off - math.pi) < 0.01)
    assert abs(distance - 1) < 0.01 if right else abs(distance - 1 - math.pi) < 0.01
PYTHON
timeout 300 "$folder/venv/bin/python" "$folder/mark.py" 2> "$folder/log" || { cat "$folder/log"; exit 1; }
if [ -s "$folder/log" ]; then cat "$folder/log"; exit 1; fi

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# DynamicAxisControl 1.0.2: a CoreXY gantry takes 146 h to go home from 100 mm, and a move of 100 mm ends at 33 mm.
#
# Two axes with 2 m/s² and 0.5 m/s. Expected of SyncCoreXYAxis: a move from (100, 100) mm to (0, 0) takes 0.65 s as the
# way there does. What happens: it takes 526 317 s, as any goal below 1 mm in both axes counts as a stroke below the
# threshold of 1 mm, also (-100, -50) mm, and such a move is made with the least acceleration and speed; the positions
# of the other motor run away to -7e12 turns. Expected of LinearMotion: all moves end at their goal, as one of 200 mm
# does. What happens to a move that is too short to reach 0.5 m/s: the positions that are returned rise to a half of the
# stroke, turn back and end at 0.328 of it. The time of the acceleration is taken as sqrt(s/2a) and not sqrt(s/a), and
# the braking begins there.
# For us: plan a short move with another library, and place the home of a gantry at 1 mm or beyond.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    DynamicAxisControl==1.0.2 numpy==2.4.6 scipy==1.17.1 matplotlib==3.10.8
cd "$folder"
export MPLBACKEND=Agg
timeout 120 venv/bin/python - > log <<'PYTHON' || { cat log; exit 1; }
import numpy as np
from DynamicAxisControl.DynamicAxisControl import ProfileGenerator

axes = ProfileGenerator(2.0, 0.5, 2.0, 0.5, 38, 1000)  # m/s², m/s, m/s², m/s, mm per turn, factor


def linear(stroke):
    """The greatest and the last position in mm."""
    positions = axes.LinearMotion(0, 0, stroke, stroke, Graph=False)['XAxisPositionTrajectory']
    return positions.max(), positions[-1]


def gantry(*move):
    """The duration in s and the last position of the second motor in turns."""
    result = axes.SyncCoreXYAxis(*move, Graph=False)
    return result['M2_AxisTimeTrajectory'][-1], result['M2_AxisPositionTrajectory'][-1]


long, short, tiny = (linear(stroke) for stroke in (200, 100, 10))
print('>', 'greatest and last position: 200 mm', long, '100 mm', short, '10 mm', tiny)
assert np.allclose(long, 200)
assert np.allclose(short, (50, 32.843), atol=0.01)
assert np.allclose(tiny, (5, 3.284), atol=0.01)
there, home, behind = gantry(0, 0, 100, 100), gantry(100, 100, 0, 0), gantry(0, 0, -100, -50)
print('>', 'duration and last position: there', there, 'home', home, 'to (-100, -50)', behind)
assert np.allclose(there, (0.65, 200 / 38))
assert home[0] > 500_000 and home[1] < -1e12
assert behind[0] > 300_000 and behind[1] < -1e12
PYTHON
grep '^>' log

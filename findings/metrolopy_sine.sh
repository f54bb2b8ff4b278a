#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# metrolopy 1.1.1: an eccentric encoder's error, a sine of ±1′, has an uncertainty of 0.35′ instead of 0.71′.
#
# Expected of gummy(ArcSinDist(center=0, half_width=1)), the distribution of a sine of unknown phase, as that of an
# eccentric disc or of the runout of a gear: a standard uncertainty of half_width / √2, as supplement 1 of the GUM
# gives it in 6.4.6. What happens: half of it, which a sum with other errors takes on. The simulation of the same
# gummy has 0.71′. Given by lower_limit=-1 and upper_limit=1, the same sine has 0.71′, but is simulated within ±2′.
# GammaDist(2, 3) has 3.46 instead of 3 √2 = 4.24, which its simulation has. The uniform, the triangular and the
# trapezoidal distribution are right in both.
# For us: give gummy(0, u=1 / 2**0.5) for a sine, and compare each budget with its simulation.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --no-compile --disable-pip-version-check \
    numpy==2.4.6 scipy==1.17.1 lazy-loader==0.6
"$folder/venv/bin/pip" install --quiet --no-compile --disable-pip-version-check --no-deps metrolopy==1.1.1
timeout 120 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from metrolopy import ArcSinDist, GammaDist, TrapezoidalDist, TriangularDist, UniformDist, gummy

CASES = {  # the right uncertainty, the one that is given, and the one of the simulation
    'sine': (ArcSinDist(center=0, half_width=1), 2**-0.5, 8**-0.5, 2**-0.5),
    'sine by its limits': (ArcSinDist(lower_limit=-1, upper_limit=1), 2**-0.5, 2**-0.5, 2**0.5),
    'gamma': (GammaDist(2, 3), 18**0.5, 12**0.5, 18**0.5),
    'uniform': (UniformDist(center=0, half_width=1), 3**-0.5, 3**-0.5, 3**-0.5),
    'triangle': (TriangularDist(mode=0, half_width=1), 6**-0.5, 6**-0.5, 6**-0.5),
    'trapezium': (TrapezoidalDist(-1, 1, 0.5), (1.25 / 6) ** 0.5, (1.25 / 6) ** 0.5, (1.25 / 6) ** 0.5),
}
for name, (distribution, right, given, drawn) in CASES.items():
    error = gummy(distribution)
    gummy.simulate([error], n=100_000)
    simulated = np.std(error.simdata)
    print(f'{name}: {right:.3f} is right, given {error.u:.3f}, simulated {simulated:.3f}')
    assert np.isclose(error.u, given) and np.isclose(simulated, drawn, rtol=0.02)
    if name == 'sine':
        assert np.isclose((error + gummy(0, u=0.1)).u, (1 / 8 + 0.01) ** 0.5)
PYTHON

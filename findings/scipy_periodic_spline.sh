#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# SciPy 1.17.1: a periodic spline of splrep() is not periodic outside of its turn, where four others are.
#
# A correction sin(φ) is given by 24 points of a turn. Asked 2 rad after its end, splev() of splrep(per=True) gives
# 0.674 instead of 0.909: it goes on along its last polynomial, and is -17 after a further half turn. BSpline made of it
# does so as well. CubicSpline, make_interp_spline and make_splrep with bc_type='periodic' wrap the angle.
# For us: a rotor turns on: use one of the others, or bring the angle into the turn with `angle % (2 * np.pi)`.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check scipy==1.17.1 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from scipy import interpolate

angles = np.linspace(0, 2 * np.pi, 25)
correction = np.sin(angles)
correction[-1] = correction[0]
knots = interpolate.splrep(angles, correction, per=True)
splines = {
    'splev': lambda angle: interpolate.splev(angle, knots),
    'BSpline': interpolate.BSpline(*knots),
    'CubicSpline': interpolate.CubicSpline(angles, correction, bc_type='periodic'),
    'make_interp_spline': interpolate.make_interp_spline(angles, correction, bc_type='periodic'),
    'make_splrep': interpolate.make_splrep(angles, correction, s=0, bc_type='periodic'),
}
for name, spline in splines.items():
    found = [float(spline(2 * np.pi + after)) for after in (-1.0, 2.0, 2.0 + np.pi)]
    print(name, found)
    wrapped = np.allclose(found, np.sin([-1.0, 2.0, 2.0 + np.pi]), atol=1e-4)
    assert wrapped == (name not in ('splev', 'BSpline'))
    assert abs(found[0] - np.sin(-1.0)) < 1e-4
    assert wrapped or abs(found[1] - 0.674) < 1e-3
PYTHON

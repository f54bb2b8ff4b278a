#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# CasADi 3.8.2: just outside of its table, a 'bspline' interpolant is 0, and a 'linear' one is extrapolated.
#
# A table gives a factor between 0.8 and 1.2 over a turn, from 0 to 2π. At 2π both give 1.0. At 2π + 1e-9, where an
# angle comes out of rounding or of a filter, 'bspline' gives 0.0 with a derivative of 0, without an error, and so at
# every angle before 0. 'linear' goes on along its last line. numpy.interp keeps the last value.
# For us: bring the angle into the turn with a margin, or let the table of a periodic quantity reach over both ends.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check casadi==3.8.2
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import casadi
import numpy as np

angles = np.linspace(0.0, 2 * np.pi, 25)
factors = 1 + 0.2 * np.sin(angles)
end = angles[-1]
asked = (end, end + 1e-9, end + 0.1, -1e-9)
for kind, expected in (('bspline', [1, 0, 0, 0]), ('linear', [1, 1, 1.01977, 1])):
    table = casadi.interpolant('factor', kind, [angles], factors)
    found = [float(table(angle)) for angle in asked]
    print(kind, found)
    assert np.allclose(found, expected, atol=1e-5)
    symbol = casadi.MX.sym('angle')
    slope = casadi.Function('slope', [symbol], [casadi.jacobian(table(symbol), symbol)])
    assert (float(slope(end + 0.1)) == 0) == (kind == 'bspline')
print('numpy.interp', np.interp(asked, angles, factors))
assert np.allclose(np.interp(asked, angles, factors), 1)
PYTHON

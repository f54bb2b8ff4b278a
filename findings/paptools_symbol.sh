#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# paptools 0.1.6: a torque of 10 ± 0.1 N·m less one of 4 ± 0.2 N·m is 0 N·m, unless each is given a symbol of its own.
#
# A Number is a value with its error and unit. Expected: 6 ± 0.22 N·m, and 2.5 ± 0.13 as the quotient. What happens: 0
# and 1, without an error and without a warning, as `symbol` has the default 'x', and the result is computed from
# symbols: x - x is 0 and x / x is 1. The sum is 8 or 20 N·m, by chance. With symbols of their own they are right. The
# second of three readings in an Array, times 2, is all three readings times 2, and the third less the first is 0. If
# one of the errors of an Array is 0, as that of cos(φ) at φ = 0, then the others are None too.
# For us: use the package uncertainties, which is right in all of these.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check paptools==0.1.6 numpy==2.4.6 uncertainties==3.2.3
timeout 100 "$folder/venv/bin/python" -W error - <<'PYTHON'
import numpy as np
import paptools
from uncertainties import ufloat

motor, load = (paptools.Number(*pair, unit='N*m') for pair in ((10, 0.1), (4, 0.2)))
right = ufloat(10, 0.1), ufloat(4, 0.2)
print('difference', motor - load, 'quotient', motor / load, 'right', right[0] - right[1], right[0] / right[1])
print('sum', motor + load, 'product', motor * load)
assert (motor - load)._value == 0 and (motor - load)._error is None
assert (motor / load)._value == 1 and (motor / load)._error is None
assert (motor + load)._value in (8, 20) and (motor * load)._value in (16, 100)

named = [paptools.Number(*triple, 'N*m') for triple in ((10, 0.1, 'a'), (4, 0.2, 'b'))]
print('with symbols', named[0] - named[1], named[0] / named[1])
assert (named[0] - named[1])._value == 6 and (named[0] / named[1])._value == 2.5
assert abs((named[0] - named[1])._error.value - (right[0] - right[1]).s) < 1e-9
assert abs((named[0] / named[1])._error.value - (right[0] / right[1]).s) < 1e-9

readings = paptools.Array([1, 2, 3], 0.1, 't', 'N*m')
print('second reading', readings[1], 'times 2', readings[1] * 2, 'third less first', readings[2] - readings[0])
assert readings[1]._value == 2
assert (readings[1] * 2)._value.tolist() == [2, 4, 6] and (readings[2] - readings[0])._value == 0

for first, errors in ((0.1, True), (0.0, False)):
    levers = paptools.cos(paptools.Array([first, 0.5, 1.2], 0.01, 'phi'))
    print('cosines', levers)
    assert np.allclose(levers._value.value, np.cos([first, 0.5, 1.2]))
    assert (levers._error is not None) == errors
PYTHON

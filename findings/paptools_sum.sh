#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# paptools 0.1.6: the sum of the angles 30 ± 0.5 and 10 ± 0.1 degrees is 20 or 60, and their ratio exactly 1.
#
# A `Number` has a value, and may have an error, a symbol and a unit. Expected of two numbers without given symbols:
# that they are two quantities. What happens: each number has the symbol "x" unless told otherwise, and what is
# calculated is an expression in the symbols, into which the values are put afterwards: `a + b` is 2 x, of whichever of
# the two comes last in a set (this changes from run to run). The difference is 0 and the ratio 1, both without error.
# Nothing warns, and the documentation does not say that the symbols have to differ. In an array, one value whose
# propagated error is 0, such as the square of 0 ± 0.1, takes the errors of all the others away.
# Output: 30 + 10: 20.0 or 60.0, 30 - 10: 0.0, 30 / 10: 1.0 ± None; with symbols: 40.0, 20.0, 3.0
#         squares of [0 ± 0.1, 20 ± 0.5]: errors None, of [10 ± 0.1, 20 ± 0.5]: errors [2.0, 20.0]
# For us: give each quantity a symbol of its own.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps paptools==0.1.6 numpy==2.4.6 \
    scipy==1.17.1 sympy==1.14.0 mpmath==1.3.0 unyt==3.2.0 packaging==26.4
cd "$folder"
timeout 120 "$folder/venv/bin/python" - <<'PYTHON'
from paptools.core.array import Array
from paptools.core.number import Number


def results(first, second):
    return [float(number._value) for number in (first + second, first - second, first / second)]


plain = Number(30.0, 0.5), Number(10.0, 0.1)
named = Number(30.0, 0.5, 'a'), Number(10.0, 0.1, 'b')
wrong, right = results(*plain), results(*named)
print(f'30 + 10: {wrong[0]}, 30 - 10: {wrong[1]}, 30 / 10: {wrong[2]} ± {(plain[0] / plain[1])._error}; '
      f'with symbols: {", ".join(map(str, right))}')
assert wrong[0] in (20, 60) and wrong[1:] == [0, 1] and right == [40, 20, 3]
assert (plain[0] / plain[1])._error is (plain[0] - plain[1])._error is None

still, moved = Array([0.0, 20.0], [0.1, 0.5], 'c'), Array([10.0, 20.0], [0.1, 0.5], 'd')
lost, kept = (still ** 2)._error, [float(each) for each in (moved ** 2)._error]
print(f'squares of [0 ± 0.1, 20 ± 0.5]: errors {lost}, of [10 ± 0.1, 20 ± 0.5]: errors {kept}')
assert lost is None and kept == [2, 20]
PYTHON

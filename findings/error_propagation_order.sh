#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# error-propagation 0.0.4: 360 minus an angle of 10 ± 0.5 degrees is -350, and the inverse of a ratio of 50 is 50.
#
# The package has a class `Complex` of a value and its standard deviation. Expected of a number minus such a value, or
# divided by one: the difference and the quotient. What happens: `__rsub__` and `__rtruediv__` are `__sub__` and
# `__truediv__`, whose operands are the other way round: the difference has the wrong sign, and the quotient is its own
# inverse. It is the value that is wrong, not its deviation alone, and no error is raised. In the right order with
# `Complex(360, 0)` the result is right.
# Output: 360 - (10 ± 0.5): -350.0 ± 0.5, by Complex(360, 0): 350.0 ± 0.5
#         1 / (50 ± 0.1): 50.0 ± 0.1, by Complex(1, 0): 0.02 ± 0.00004
#         7200 deg / (50 ± 0.1): 0.0069 (is 144)
# For us: use `uncertainties`.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps error-propagation==0.0.4 numpy==2.4.6
cd "$folder"
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from error_propagation import Complex

angle, ratio = Complex(10, 0.5), Complex(50, 0.1)

wrong, right = 360 - angle, Complex(360, 0) - angle
print(f'360 - (10 ± 0.5): {wrong}, by Complex(360, 0): {right}')
assert (wrong.value, wrong.error) == (-350, 0.5) and (right.value, right.error) == (350, 0.5)

wrong, right = 1 / ratio, Complex(1, 0) / ratio
print(f'1 / (50 ± 0.1): {wrong}, by Complex(1, 0): {right.value} ± {right.error:.5f}')
assert (wrong.value, wrong.error) == (50, 0.1) and right.value == 0.02 and abs(right.error - 4e-5) < 1e-9

output = 7200 / ratio
print(f'7200 deg / (50 ± 0.1): {output.value:.4f} (is 144)')
assert output.value == 50 / 7200
PYTHON

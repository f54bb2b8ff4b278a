#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# error-propagation 0.0.4: one divided by a gear ratio of 19 ± 0.19 is 19 ± 0.19, and 5 minus a torque of 2 is -3.
#
# A Complex is a value with a standard deviation, and numbers and arrays may stand on either side of an operator.
# Expected of 1 / ratio: 0.05263 ± 0.00053. What happens: with a plain number or an array on the left, a quotient and a
# difference are those of exchanged operands: 1 / ratio is ratio / 1, 38 / ratio is 0.5 instead of 2, and 5 - torque is
# torque - 5. Sums, products and powers are right, and so is each operation between two objects of Complex.
# For us: write Complex(1, 0) / ratio, or use the package uncertainties, which is right.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check error-propagation==0.0.4 numpy==2.4.6 uncertainties==3.2.3
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from error_propagation import Complex
from uncertainties import ufloat

ratio, torque = Complex(19.0, 0.19), Complex(2.0, 0.1)
right_ratio, right_torque = ufloat(19.0, 0.19), ufloat(2.0, 0.1)


def close(found, value, error):
    return abs(found.value - value) < 1e-9 and abs(found.error - error) < 1e-9


for name, found, right in (
    ('1 / ratio', 1 / ratio, 1 / right_ratio),
    ('38 / ratio', 38 / ratio, 38 / right_ratio),
    ('5 - torque', 5 - torque, 5 - right_torque),
    ('Complex(1, 0) / ratio', Complex(1, 0) / ratio, 1 / right_ratio),
    ('2 * ratio', 2 * ratio, 2 * right_ratio),
    ('2 ** torque', 2.0**torque, 2.0**right_torque),
):
    print(f'{name}: {found}, right is {right.nominal_value} ± {right.std_dev}')
assert close(1 / ratio, 19, 0.19) and close(38 / ratio, 0.5, 0.005) and close(5 - torque, -3, 0.1)
for found, right in ((Complex(1, 0) / ratio, 1 / right_ratio), (2.0**torque, 2.0**right_torque)):
    assert close(found, right.nominal_value, right.std_dev)
assert [quotient.value for quotient in np.array([1.0, 2.0]) / ratio] == [19.0, 9.5]
PYTHON

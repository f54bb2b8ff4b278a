#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# physlab 1.0.8: a torque of 0 ± 0.1 N·m at a gear of 19 is exactly 0, (-2 ± 0.01)² is 4 ± 0.4, and 2 to the 3rd is 9.
#
# A phys is a value with a standard deviation; the README says that a power has its full calculation, and gives 2 ** a.
# Expected: 0 ± 1.9 N·m, 4 ± 0.04 and 8. What happens: the deviation of a product or quotient is made of relative
# ones, of which that of 0 is infinite; 0 times infinity is then replaced by a tenth of the result, which is 0. Of a
# negative number each power has a tenth of itself as its deviation, without a warning, so that an error of the speed
# of a shaft that turns back is 10 times too large. With a plain number below, base and exponent are exchanged: 2 **
# phys(3, 0.1) is 3² ± 0. Sums, products with plain numbers, and positive values are right.
# For us: use the package uncertainties, which is right in all of these.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check physlab==1.0.8 numpy==2.4.6 uncertainties==3.2.3
MPLBACKEND=Agg MPLCONFIGDIR="$folder" timeout 100 "$folder/venv/bin/python" - <<'PYTHON'
from physlab import phys
from uncertainties import ufloat

CASES = {
    'torque of 0 times a ratio': (lambda number: number(0.0, 0.1) * number(19.0, 0.1), 0, 0),
    'angle of 0 over a ratio': (lambda number: number(0.0, 0.1) / number(19.0, 0.1), 0, 0),
    'square of a negative speed': (lambda number: number(-2.0, 0.01) ** 2, 4, 0.4),
    'square of a positive speed': (lambda number: number(2.0, 0.01) ** 2, 4, 0.04),
    '2 to the power 3': (lambda number: 2 ** number(3.0, 0.1), 9, 0),
    'product of 2 and 19': (lambda number: number(2.0, 0.1) * number(19.0, 0.1), 38, 1.9105),
}
wrong = []
for name, (operation, value, deviation) in CASES.items():
    found, right = operation(phys), operation(ufloat)
    print(f'{name}: {found.value} ± {found.sigma}, right is {right.nominal_value} ± {right.std_dev}')
    assert abs(found.value - value) < 1e-9 and abs(found.sigma - deviation) < 1e-4
    if abs(found.value - right.nominal_value) > 1e-9 or abs(found.sigma - right.std_dev) > 1e-4:
        wrong.append(name)
assert len(wrong) == 4
PYTHON

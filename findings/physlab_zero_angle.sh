#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# physlab 1.0.8: the torque at an angle of 0 ± 0.1 degrees is exactly 0, and the 2 ** 12 counts of an encoder are 144.
#
# The package propagates the uncertainties of quantities. Expected of a product with 0: the other factor times the
# uncertainty of the 0. What happens: it is calculated by relative uncertainties, which are infinite at 0; what is NaN
# in the end is replaced by a tenth of the result, which is 0: the product, and the quotient too, count as exact. For a
# power of a negative value the tenth is given as well, whatever the uncertainty: (-30 ± 0.5)^2 is 900 ± 90 instead of
# 900 ± 30, and (-2 ± 0.01)^3 is -8 ± 0.8 instead of -8 ± 0.12. A number to the power of a quantity, which the
# documentation shows (`2 ** a`), is calculated as the quantity to the power of the number, without uncertainty.
# Output: torque of 0 ± 0.1 deg at 50 ± 1 Nm/deg: 0.0 ± 0.0, of 0.1 ± 0.1 deg: 5.0 ± 5.0
#         (30 ± 0.5)^2: 900.0 ± 30.0, (-30 ± 0.5)^2: 900.0 ± 90.0
#         2 ** 12: 144.0 ± 0.0, 2 ** (3 ± 0.1): 9.0 ± 0.0
# For us: use `uncertainties`.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps physlab==1.0.8 numpy==2.4.6 \
    matplotlib==3.11.2 contourpy==1.3.3 cycler==0.12.1 fonttools==4.68.0 kiwisolver==1.5.1 packaging==26.4 \
    pillow==13.0.0 pyparsing==3.3.3 python-dateutil==4.0.0
cd "$folder"
MPLBACKEND=Agg timeout 120 "$folder/venv/bin/python" - <<'PYTHON'
from physlab import phys


def text(quantity):
    return f'{quantity.value} ± {quantity.sigma:.1f}'


def seen(quantity):
    return round(float(quantity.value), 9), round(float(quantity.sigma), 9)


stiffness = phys(50.0, 1.0)
still, moved = phys(0.0, 0.1) * stiffness, phys(0.1, 0.1) * stiffness
print(f'torque of 0 ± 0.1 deg at 50 ± 1 Nm/deg: {text(still)}, of 0.1 ± 0.1 deg: {text(moved)}')
assert seen(still) == (0, 0) and abs(seen(moved)[1] - 5.001) < 1e-3
assert seen(phys(0.0, 0.1) / stiffness) == (0, 0) and seen(phys(0.0, 0.1) * 50) == (0, 5)
assert (phys([0.0, 0.1], 0.1) * stiffness).sigma[0] == 0  # In a list of angles too.

positive, negative = phys(30.0, 0.5) ** 2, phys(-30.0, 0.5) ** 2
print(f'(30 ± 0.5)^2: {text(positive)}, (-30 ± 0.5)^2: {text(negative)}')
assert seen(positive) == (900, 30) and seen(negative) == (900, 90)
assert seen(phys(-2.0, 0.01) ** 3) == (-8, 0.8)

counts, uncertain = 2 ** phys(12, 0), 2 ** phys(3, 0.1)
print(f'2 ** 12: {text(counts)}, 2 ** (3 ± 0.1): {text(uncertain)}')
assert seen(counts) == (144, 0) and seen(uncertain) == (9, 0)
PYTHON

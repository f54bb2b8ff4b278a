#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# measurement-stats 0.3.0: the square of a resolution of 5e-6 rad is 5e-6, and the inverse of a ratio of 50 is 50.
#
# The package calculates with values that have uncertainties. Expected of a power of a small value, of a number divided
# by a value, and of a product with 0 ± 0.1: those of the values. What happens: a value below 1e-5 is its own power,
# whatever the exponent; a number divided by a value is the value divided by the number; the uncertainty of a product
# with 0 is the root of the sum of the squares, of whatever unit the factors are. Expected of the weighted mean of two
# encoders that are nearly equally good: their middle. What happens: it is calculated of the values and uncertainties as
# they are rounded for printing, to one digit, though the documentation says that these are not for calculations: 0.149
# is 0.1 and 0.151 is 0.2, so that one counts four times as much as the other.
# Output: (5e-06 rad)^2: 5e-06, (8e-06)^-1: 8e-06
#         1 / (50 ± 0.1): 50.0 ± 0.1
#         (0 ± 0.1 deg) (50 ± 1 Nm/deg): 0.0 ± 1.0 (is ± 5)
#         mean of 10.0 ± 0.149 and 10.4 ± 0.151 deg: 10.08 ± 0.09 (is 10.20 ± 0.11)
# For us: use `uncertainties`.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps measurement-stats==0.3.0 numpy==2.4.6 \
    scipy==1.17.1 six==1.17.0
cd "$folder"
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from measurement_stats import mean
from measurement_stats.value import ValueUncertainty

square, inverse = ValueUncertainty(5e-6, 1e-7) ** 2, ValueUncertainty(8e-6, 1e-7) ** -1
print(f'(5e-06 rad)^2: {square.raw}, (8e-06)^-1: {inverse.raw}')
assert (square.raw, square.raw_uncertainty) == (5e-6, 1e-7) and inverse.raw == 8e-6
assert abs((ValueUncertainty(5e-5, 1e-7) ** 2).raw - 2.5e-9) < 1e-18  # As it is for larger ones.

stiffness = ValueUncertainty(50, 1)
ratio = 1 / ValueUncertainty(50, 0.1)
print(f'1 / (50 ± 0.1): {ratio.raw} ± {ratio.raw_uncertainty}')
assert (ratio.raw, ratio.raw_uncertainty) == (50, 0.1)

torque = ValueUncertainty(0, 0.1) * stiffness
print(f'(0 ± 0.1 deg) (50 ± 1 Nm/deg): {torque.raw} ± {torque.raw_uncertainty:.1f} (is ± 5)')
assert torque.raw == 0 and abs(torque.raw_uncertainty - (0.1 ** 2 + 1) ** 0.5) < 1e-9

first, second = ValueUncertainty(10.0, 0.149), ValueUncertainty(10.4, 0.151)
weights = [each.raw_uncertainty ** -2 for each in (first, second)]
right = (weights[0] * first.raw + weights[1] * second.raw) / sum(weights)
found = mean.weighted(first, second)
print(f'mean of 10.0 ± 0.149 and 10.4 ± 0.151 deg: {found.raw:.2f} ± {found.raw_uncertainty:.2f} '
      f'(is {right:.2f} ± {sum(weights) ** -0.5:.2f})')
assert abs(found.raw - 10.08) < 1e-9 and abs(right - 10.197) < 1e-3
PYTHON

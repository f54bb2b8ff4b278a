#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# auto-uncertainties 1.1.0: the counts of an angle known to 0.4 degrees are exact; an angle rounded to 0.01 is ± 0.5.
#
# The package propagates the uncertainty of values through functions of NumPy. Expected of rounding: an uncertainty not
# below that of the value (half of the last place may be added), and about the same of `rint`, `floor`, `ceil`, `round`.
# What happens: `rint`, `floor` and `ceil` are applied to the uncertainty itself too: 0.4 becomes 0, and by `ceil` 1, so
# that a value uncertain by up to 0.5 is exact afterwards by `rint`, and 0.002 becomes 1 by `ceil`. `np.round` and the
# method `round()` add 0.5 to the uncertainty whatever the number of decimals; Python's `round()` leaves it as it is.
# Output: rint: 45.0 ± 0.0, floor: 45.0 ± 0.0, ceil: 46.0 ± 1.0 (of 45.3 ± 0.4 degrees)
#         12.3456 ± 0.002 to 2 decimals: ± 0.502 by np.round, ± 0.002 by round
# For us: round the value for display only, and calculate with what was not rounded.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps auto-uncertainties==1.1.0 numpy==2.4.6 \
    jax==0.10.2 jaxlib==0.10.2 joblib==1.6.0 loguru==0.7.3 lazy-loader==0.4 ml-dtypes==0.6.0 opt-einsum==3.4.0 \
    packaging==26.4 pydantic==2.14.4 pydantic-core==2.50.5 pydantic-settings==2.16.3 python-dotenv==1.2.4 \
    scipy==1.17.1 typing-extensions==4.16.0 typing-inspection==0.4.5 annotated-types==0.8.0 cloudpickle==3.1.3
cd "$folder"
timeout 120 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from auto_uncertainties import Uncertainty

angle = Uncertainty(np.array([45.3]), np.array([0.4]))
found = {name: getattr(np, name)(angle) for name in ('rint', 'floor', 'ceil')}
print(', '.join(f'{name}: {result.value[0]} ± {result.error[0]}' for name, result in found.items()),
      '(of 45.3 ± 0.4 degrees)')
assert {name: (result.value[0], result.error[0]) for name, result in found.items()} == {
    'rint': (45, 0), 'floor': (45, 0), 'ceil': (46, 1)}
assert np.rint(Uncertainty(45.3, 0.4)).error == 0  # A single value too, and what is calculated from it:
assert (np.rint(angle) * 0.01 + Uncertainty(np.array([0.0]), np.array([0.0]))).error[0] == 0

angle = Uncertainty(np.array([12.3456, 45.0]), np.array([0.002, 0.002]))  # A single one is a TypeError.
print(f'12.3456 ± 0.002 to 2 decimals: ± {np.round(angle, 2).error[0]} by np.round, ± {round(angle, 2).error[0]} by '
      'round')
assert np.round(angle, 2).value[0] == round(angle, 2).value[0] == 12.35
assert np.round(angle, 2).error[0] == angle.round(2).error[0] == np.round(angle, 4).error[0] == 0.502
assert round(angle, 2).error[0] == 0.002 and np.ceil(angle).error[0] == 1
PYTHON

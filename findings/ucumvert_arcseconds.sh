#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# ucumvert 0.3.2: an encoder's error of 20″ is a time of 20 s, and a drift of 6'/h is 0.1 without a unit.
#
# In UCUM, ' and '' are the minute and the second of a plane angle; those of time are min and s. Expected of
# from_ucum("''"), which gives a unit of Pint: arcsecond, so that 20 of it are 0.00556°. What happens: "second", so that
# 20 '' are 20 s or 0.333 min, a drift of 6 '/h has no dimension and is 0.1, and a conversion to degrees is an error of
# dimensions. deg, gon and circ are right, and so are min and s.
# For us: take Pint's arcminute and arcsecond for ' and ''.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check ucumvert==0.3.2 pint==0.25.3
cat > "$folder/error.py" <<'PYTHON'
import pint
from ucumvert import PintUcumRegistry

registry = PintUcumRegistry()


def of(value, unit):
    found = registry.Quantity(value, registry.from_ucum(unit))
    print(f'{value} {unit} is {found:g}')
    return found


error = of(20, "''")
print('which are', error.to('minute'))
assert error.units == registry.second and error.to('minute').magnitude == 20 / 60
assert of(1, "'").units == registry.minute and of(1, 'min').units == registry.minute
drift = of(6, "'/h")
print('which is', drift.to_base_units())
assert drift.dimensionless and abs(drift.to_base_units().magnitude - 0.1) < 1e-12
try:
    error.to('degree')
except pint.DimensionalityError as refused:
    print(refused)
else:
    raise SystemExit("'' is an angle")
for unit, degrees in ('deg', 1), ('gon', 0.9), ('circ', 360):
    assert abs(of(1, unit).to('degree').magnitude - degrees) < 1e-12
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/error.py"

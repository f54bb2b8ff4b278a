#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# Pint 0.25.3: "1.5 Nm" is read as the fineness of a yarn, not as a torque.
#
# Expected: newton metres, or an error, as Pint wants a space or a sign between two units. What happens: Nm is the
# metric count of a yarn, 1 km/kg, and mNm is a thousandth of it. The text is printed as "1.5 Nm", and so are sums,
# ratios and comparisons of such values, so nothing shows it until a value meets a real torque: 1.5 Nm · 100 rad/s is no
# power but 150000 m·rad/(kg·s). A stiffness of "3 Nm/arcmin" is read in the same way.
# For us: the tables of drives say Nm; give Pint "N*m" or "N m".
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pint==0.25.3
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import pint

units = pint.UnitRegistry()
torque = units('1.5 Nm')
print(f'{torque:~P}', torque, 'in base units', torque.to_base_units())
assert f'{torque:~P}' == '1.5 Nm' and torque.to_base_units() == units('1500 m/kg')
assert torque + units('500 mNm') == units('2 Nm')
assert torque / units('0.5 Nm') == 3
power = (torque * units('100 rad/s')).to_base_units()
print('times 100 rad/s', power)
assert power.units == units('m * rad / kg / s').units and abs(power.magnitude - 150_000) < 1e-6
assert not torque.is_compatible_with('N*m') and not units('3 Nm/arcmin').is_compatible_with('N*m/rad')
for text in ('1.5 N*m', '1.5 N m', '1.5 N·m'):
    assert units(text).is_compatible_with('J')
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# quantities 0.16.4: 6000 rpm are 628 Hz.
#
# A rotor of 6000 rpm excites its housing with 100 Hz. Its speed is converted to 628.3 Hz, since a turn is 2π radians, a
# radian is 1, and a hertz is 1/s. So the orders of a spectrum are sought at 6.28 times their frequency, and a
# resolution of 4096 counts per turn becomes 652 counts where the unit of an angle is dropped. Neither is announced.
# Pint 0.25.3 does the same, and its documentation says so. unyt 3.2.0 and Astropy 8.0.2 refuse to convert a speed of
# rotation to hertz.
# For us: divide by a turn first, as in `speed / quantities.turn`, or by 2π, before a speed is called a frequency.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    unyt==3.2.0 quantities==0.16.4 pint==0.25.3 astropy==8.0.2 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import math

import astropy.units
import pint
import quantities
import unyt

ureg = pint.UnitRegistry()
frequencies = {
    'pint': ureg('6000 rpm').to('Hz').magnitude,
    'quantities': float((6000 * quantities.rpm).rescale('Hz')),
}
print(frequencies)
assert all(abs(frequency - 200 * math.pi) < 1e-9 for frequency in frequencies.values())
counts = float((4096 * quantities.count / quantities.turn).simplified)
print('counts per turn without the unit of an angle', counts)
assert abs(counts - 4096 / math.tau) < 1e-9
assert abs(float((6000 * quantities.rpm / quantities.turn).rescale('Hz')) - 100) < 1e-9
speed = 6000 * astropy.units.cycle / astropy.units.minute
for refused in (
    lambda: unyt.unyt_quantity(6000, 'rpm').to('Hz'),
    lambda: speed.to(astropy.units.Hz),
):
    try:
        refused()
    except (unyt.exceptions.UnitConversionError, astropy.units.UnitConversionError) as error:
        print(error)
    else:
        raise AssertionError('it is converted')
PYTHON

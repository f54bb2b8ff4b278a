#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# unyt 3.2.0, quantities 0.16.4: numpy.unwrap() of an angle in degrees adds turns of 6.28 degrees.
#
# A single-turn encoder passes from 350° to 10°, which is 370°. Astropy 8.0.2 and Pint 0.25.3 say so. With unyt and
# with quantities the result is 349.29°: the period 2π is taken as a number of degrees, the result keeps its unit, and
# no error is raised. The same angle in radians is unwrapped right.
# For us: convert to radians, or unwrap the bare numbers with period=360, before the unit is added.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    unyt==3.2.0 quantities==0.16.4 pint==0.25.3 astropy==8.0.2 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import astropy.units
import numpy as np
import pint
import quantities
import unyt

degrees = np.array([350.0, 10.0])
radians = np.radians(degrees)
for name, angle, other, second in (
    ('astropy', degrees * astropy.units.deg, radians * astropy.units.rad, 370.0),
    ('pint', pint.UnitRegistry().Quantity(degrees, 'degree'), None, 370.0),
    ('unyt', unyt.unyt_array(degrees, 'degree'), unyt.unyt_array(radians, 'rad'), 349.292),
    ('quantities', degrees * quantities.deg, radians * quantities.rad, 349.292),
):
    unwrapped = np.unwrap(angle)
    print(name, unwrapped)
    assert abs(getattr(unwrapped, 'magnitude', np.asarray(unwrapped))[1] - second) < 1e-3
    if other is not None:
        assert np.allclose(np.asarray(np.unwrap(other)), np.radians([350.0, 370.0]))
PYTHON

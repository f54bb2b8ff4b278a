#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mechanism 1.1.10: the base circle of a cam with an offset roller is 9 % too small, and its pressure angle is 32° where
# 30° is the limit.
#
# A cycloidal rise of 30 mm within 90°, a roller of 10 mm, offset by 30 mm, a greatest pressure angle of 30°. Expected
# of get_base_circle(): a base circle of 98.7 mm, at which the normal of the roller's path is 30° away from the
# follower's axis at most. What happens: 90.1 mm and 32.0°, as the square of the offset is added to that of the prime
# circle's radius instead of subtracted. Without an offset it is right, 42.5 mm.
# For us: size a cam with an offset follower by the slope of its roller's path.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mechanism==1.1.10 numpy==2.4.6 scipy==1.17.1 \
    matplotlib==3.10.8
cd "$folder"
MPLBACKEND=Agg timeout 100 venv/bin/python - <<'PYTHON'
import numpy as np
from mechanism import Cam
from scipy.optimize import brentq

ROLLER, LIMIT = 0.010, 30
CAM = Cam(motion=[('Rise', 0.03, 90), ('Dwell', 90), ('Fall', 0.03, 90), ('Dwell', 90)], degrees=True, omega=2 * np.pi)


def pressure_angle(base, offset):
    """The greatest angle, °, between the normal of the roller's path on the cam and the axis of the follower."""
    lowest = np.sqrt((base + ROLLER) ** 2 - offset**2)  # of the roller's centre, along the axis of the follower
    path = (offset + 1j * (lowest + CAM.cycloidal.S)) * np.exp(-1j * CAM.thetas)  # as the cam sees it
    tangents = np.gradient(path, CAM.thetas) * np.exp(1j * CAM.thetas)
    slopes = np.abs(tangents.imag) / np.abs(tangents)
    return np.degrees(np.arcsin(slopes[5:-5].max()))


for offset, expected, angle in ((0.0, 0.0425, 30.0), (0.03, 0.0901, 32.0)):
    base = CAM.get_base_circle(
        kind='cycloidal', follower='roller', roller_radius=ROLLER, eccentricity=offset, max_pressure_angle=LIMIT
    )['Rb']
    right = brentq(lambda radius: pressure_angle(radius, offset) - LIMIT, 0.03, 0.5)
    print(f'offset {offset} m: base circle {base:.4f} m instead of {right:.4f} m, {pressure_angle(base, offset):.2f}°')
    assert abs(base - expected) < 1e-4 and abs(pressure_angle(base, offset) - angle) < 0.1
    assert abs(right - (0.0987 if offset else expected)) < 1e-4
PYTHON

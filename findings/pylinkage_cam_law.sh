#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pylinkage 1.3.0: a cam that lifts a brake by 10 mm with a modified trapezoid has a step of 10 mm in its flank.
#
# A cam has a base circle of 20 mm and rises by 10 mm within a quarter turn. Expected of ModifiedTrapezoidalMotionLaw,
# with a continuous acceleration that is lower than that of the harmonic law: a flank that rises all the way, and by
# 5 mm in the middle. What happens: the pieces of the law do not meet. At half of the rise the radius steps from
# 23.75 mm to 26.25 mm, at three quarters it is back at 20.3 mm, and at seven eighths it steps from 19.1 mm, inside
# of the base circle, to 29.3 mm. The fall, which is the rise turned over, goes beyond the lift, to 30.9 mm. Also,
# velocity() is not the slope of displacement(), so that evaluate_derivative() belongs to another cam: it is 0 in the
# middle, where a cam is steepest. There is no error. The harmonic, the cycloidal and the polynomial law are right.
# For us: take polynomial_345() or CycloidalMotionLaw, and compare the radii of a profile with their own derivative
# before a cam is made.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pylinkage==1.3.0 numpy==2.2.6
cat > "$folder/cam.py" <<'PYTHON'
import numpy as np
from pylinkage.cam import (
    CycloidalMotionLaw,
    FunctionProfile,
    HarmonicMotionLaw,
    ModifiedTrapezoidalMotionLaw,
    polynomial_345,
)

BASE, LIFT, RISE, SMALL = 20.0, 10.0, np.pi / 2, 1e-6
PLACES = (0.0, 0.25, 0.499, 0.501, 0.75, 0.874, 0.876, 0.937, 1.0)  # shares of the rise


def flank(law):
    """Return the radii at the places, the greatest step between 2000 points, and how far the derivative is off."""
    cam = FunctionProfile(
        motion_law=law,
        base_radius=BASE,
        total_lift=LIFT,
        rise_start=0.0,
        rise_end=RISE,
        dwell_high_end=np.pi,
        fall_end=3 * np.pi / 2,
    )
    radii = [cam.evaluate(share * RISE) for share in PLACES]
    angles = np.linspace(0.01, 0.99, 2000) * RISE
    steps = np.abs(np.diff([cam.evaluate(angle) for angle in angles])).max()
    slopes = np.array([(cam.evaluate(angle + SMALL) - cam.evaluate(angle - SMALL)) / (2 * SMALL) for angle in angles])
    off = np.abs(slopes - [cam.evaluate_derivative(angle) for angle in angles])
    middle = cam.evaluate_derivative(RISE / 2)
    print(f'{type(law).__name__}: {np.round(radii, 2)} mm, greatest step {steps:.3f} mm')
    print(f'  the derivative is off by up to {off.max():.2f} mm/rad, and {middle:.2f} mm/rad in the middle')
    highest = max(cam.evaluate(angle) for angle in np.linspace(0, 2 * np.pi, 8001))
    return radii, steps, off, middle, highest


for law in (HarmonicMotionLaw(), CycloidalMotionLaw(), polynomial_345()):
    radii, steps, off, middle, highest = flank(law)
    assert np.all(np.diff(radii) > 0) and steps < 0.02 and off.max() < 1e-4 and middle > 9 and highest < 30 + 1e-9
radii, steps, off, middle, highest = flank(ModifiedTrapezoidalMotionLaw())
print(f'highest {highest:.2f} mm')
assert np.allclose(radii, (20, 20.94, 23.75, 26.25, 20.31, 19.07, 29.29, 29.56, 30), atol=0.02)
assert 10 < steps < 10.3 and off.max() > 4 and abs(middle) < 1e-6 and np.isclose(highest, 30.92, atol=0.02)
PYTHON
timeout 300 "$folder/venv/bin/python" "$folder/cam.py"

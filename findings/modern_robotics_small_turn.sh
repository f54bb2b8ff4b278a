#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# modern-robotics 1.1.1: a joint that is turned by 0.9 µrad stands at 0, so that SciPy calibrates an offset as 0.
#
# The matrix exponentials behind FKinSpace() and FKinBody() take an angle below 1 µrad as none, where the exact formula
# has no difficulty: 1.1 µrad are 1.1 µm at an arm of 1 m, 0.9 µrad are 0. So a derivative by differences is 0 at an
# angle of 0, and SciPy's is one of steps of 15 nrad. Expected of least_squares(), which is to find the offset of a
# joint, 10 mrad, from the positions of the tip: 10 mrad. What happens: its first derivative is 0, it ends at once at an
# offset of 0 and reports success. From a start of 0.1 rad, or with the Jacobian of the library, it is right.
# For us: give JacobianSpace() or a step (diff_step with a start that is not 0) to what optimizes over these functions.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check modern-robotics==1.1.1 scipy==1.17.1 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import modern_robotics
import numpy as np
from scipy.optimize import least_squares

HOME = np.array([[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
SCREW = np.array([[0, 0, 1, 0, 0, 0.0]]).T
measured = np.array([np.cos(0.01), np.sin(0.01)])


def tip(angle):
    return modern_robotics.FKinSpace(HOME, SCREW, [angle])[:2, 3]


def residual(offset):
    return tip(offset[0]) - measured


print('the tip at 1.1 and 0.9 µrad', tip(1.1e-6)[1], tip(0.9e-6)[1])
assert abs(tip(1.1e-6)[1] - 1.1e-6) < 1e-12 and tip(0.9e-6)[1] == 0
stuck, found = least_squares(residual, [0.0]), least_squares(residual, [0.1])
print('from 0:', stuck.x, stuck.success, stuck.message, 'from 0.1:', found.x)
assert stuck.success and stuck.x[0] == 0 and abs(found.x[0] - 0.01) < 1e-6


def slope(offset):
    twist = modern_robotics.JacobianSpace(SCREW, offset)[:, 0]
    return (np.cross(twist[:3], [*tip(offset[0]), 0]) + twist[3:])[:2, None]


assert abs(least_squares(residual, [0.0], jac=slope).x[0] - 0.01) < 1e-6
PYTHON

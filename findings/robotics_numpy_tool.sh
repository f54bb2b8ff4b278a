#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# robotics-numpy 0.1.0: its Jacobian counts a tool twice, and a flange that points straight down has a wrong rotation.
#
# An arm of 0.4 m and 0.3 m with a tool of 0.1 m, at 0.3 rad and 0.5 rad. Expected of jacob0(): what differences of
# fkine() give, 0.6608 m/rad along y for the first joint. What happens: 0.7305 m/rad, as the position of the tip already
# has the tool, which is added to it again; without a tool it is right. Expected of r2rpy() at a pitch of 90°: a roll of
# 0 and a yaw that make the same rotation. What happens: of a roll of -0.5 rad and a yaw of 0.5 rad it makes a yaw of
# -1 rad instead of 1 rad, a rotation that differs by 2 rad; -90° is right, and so is 89.99°. Expected of islimit() of
# an arm with limits of -1 to 2 rad and -3 to 0.5 rad: at (2, 0) the first joint is at its limit. What happens: it is
# not, as both limits of the first joint are taken for the lower limits of the two.
# For us: give the tool as the last link, and take the angles of a flange from scipy's Rotation.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check robotics-numpy==0.1.0 numpy==2.4.6
cd "$folder"
timeout 60 venv/bin/python - > log <<'PYTHON' || { cat log; exit 1; }
import numpy as np
from robotics_numpy.models import DHRobot, RevoluteDH
from robotics_numpy.transforms import SE3
from robotics_numpy.transforms.rotations import r2rpy, rpy2r


def compared(tool):
    """The movement along y per angle of the first joint, by jacob0() and by differences of fkine()."""
    arm = DHRobot([RevoluteDH(a=0.4), RevoluteDH(a=0.3)], tool=SE3.Trans(tool, 0, 0))
    step = 1e-6
    difference = arm.fkine([0.3 + step, 0.5]).t - arm.fkine([0.3 - step, 0.5]).t
    found = arm.jacob0([0.3, 0.5])[1, 0], difference[1] / (2 * step)
    print('>', f'tool of {tool} m: jacob0() {found[0]:.4f} m/rad, differences {found[1]:.4f} m/rad')
    return found


assert np.allclose(*compared(0.0), atol=1e-6)
assert np.allclose(compared(0.1), (0.7305, 0.6608), atol=1e-4)


def angle_between(pitch):
    """The angle in rad between a rotation and the one that its roll, pitch and yaw make."""
    rotation = rpy2r(-0.5, pitch, 0.5)
    angles = [float(angle) for angle in r2rpy(rotation)]
    trace = np.trace(rotation.T @ rpy2r(*angles))
    angle = np.arccos(np.clip((trace - 1) / 2, -1, 1))
    print('>', f'pitch {np.degrees(pitch):.2f}°: {np.round(angles, 3)}, {angle:.3f} rad away')
    return angle


assert np.isclose(angle_between(np.pi / 2), 2.0)
assert angle_between(-np.pi / 2) < 1e-6 and angle_between(np.radians(89.99)) < 1e-6
limited = DHRobot([RevoluteDH(a=0.4, qlim=[-1, 2]), RevoluteDH(a=0.3, qlim=[-3, 0.5])])
at_upper, at_lower = limited.islimit([2.0, 0.0]).tolist(), limited.islimit([-1.0, 0.0]).tolist()
print('>', 'at the upper limit of the first joint', at_upper, 'at its lower limit', at_lower)
assert at_upper == [False, False] and at_lower == [True, False]
PYTHON
grep '^>' log

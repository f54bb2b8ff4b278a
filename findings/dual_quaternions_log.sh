#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# dual-quaternions 0.4.0: the logarithm of a flange's pose loses its translation, and half of it is not half of the way.
#
# log() is documented as the map of a pose "to the tangent space at the identity", and exp() as the way back; both are
# derived at length in its README. Expected: log().exp() is the pose itself, and the exponential of half the logarithm
# is half of the way, as pow(0.5) and sclerp() find it. What happens: a pose 0.3 m above the origin comes back at the
# origin, with or without a turn about that direction, as does each pure translation; a pose at (1, 0, 0) m that is
# turned by 90° about z comes back at (0.5, 0.5, 0) m. The turns are right. There is no warning. sclerp() between two
# equal poses is an AttributeError.
# For us: interpolate poses by pow() or sclerp(), and take logarithms by Pinocchio's log6().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check dual-quaternions==0.4.0 pyquaternion==0.9.9 numpy==2.4.6
timeout 100 "$folder/venv/bin/python" - <<'PYTHON'
import math

import numpy as np
from dual_quaternions import DualQuaternion


def pose(angle, position):
    return DualQuaternion.from_quat_pose_array([math.cos(angle / 2), 0, 0, math.sin(angle / 2), *position])


for name, angle, position, found in (
    ('translation', 0.0, (0.1, 0.2, 0.3), (0, 0, 0)),
    ('along the axis', 1.0, (0, 0, 0.3), (0, 0, 0)),
    ('across the axis', math.pi / 2, (1, 0, 0), (0.5, 0.5, 0)),
):
    start, stop = DualQuaternion.identity(), pose(angle, position)
    back, half, right = stop.log().exp(), (0.5 * stop.log()).exp(), stop.pow(0.5)
    print(name, position, 'log().exp()', np.round(back.translation(), 6), 'half', np.round(half.translation(), 6))
    print('half by pow()', np.round(right.translation(), 6))
    assert np.allclose(stop.translation(), position) and np.allclose(back.translation(), found, atol=1e-9)
    assert abs(back.q_r.w - stop.q_r.w) < 1e-9 and abs(back.q_r.z - stop.q_r.z) < 1e-9
    assert (right * right) == stop or np.allclose((right * right).dq_array(), stop.dq_array())
    assert np.allclose(DualQuaternion.sclerp(start, stop, 0.5).translation(), right.translation())
    assert np.allclose(half.translation(), np.array(found) / 2, atol=1e-9)
    assert not np.allclose(half.translation(), right.translation(), atol=0.05)
try:
    DualQuaternion.sclerp(stop, stop, 0.5)
except AttributeError as error:
    print('sclerp() between equal poses:', error)
else:
    raise AssertionError('sclerp() between equal poses is no error')
PYTHON

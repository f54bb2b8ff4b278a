#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# quatpy 2025.1.1: a flange at 10°, 20° and 30° about x, y and z is read back at 19°, 12° and 34°.
#
# Expected of from_angles(), which takes "extrinsic rotations (global frame)": first 10° about x, then 20° about the y
# and 30° about the z of the base, so that the flange's own x axis, which is not moved by the first turn, points to
# (cos 20° cos 30°, cos 20° sin 30°, -sin 20°). What happens: it points 8.9° beside this, as the rotations are about
# turned axes. Expected of to_angles() of this quaternion in the same order: the three angles. What happens: 19.0°,
# 11.8° and 33.8°, as to_angles() takes the axes as fixed; each of the six orders is read back wrong.
# For us: check that a conversion of angles and the one back give what went in, with three angles that differ.
#
# Exit code 0: still so. Installs the versions into a temporary folder; quatpy asks for Python 3.12, but runs on 3.11.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --ignore-requires-python quatpy==2025.1.1
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import numpy as np
import quaternions

angles = np.radians([10.0, 20.0, 30.0])
flange = np.asarray(quaternions.from_angles(angles)).ravel()
axis = quaternions.quat_rotate(flange, np.array([1.0, 0.0, 0.0]))
_, pitch, yaw = angles
right = np.array([np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), -np.sin(pitch)])
beside = np.degrees(np.arccos(axis @ right))
back = np.degrees(quaternions.to_angles(flange))
print('axis', axis, 'instead of', right, beside, '° beside; angles read back', back)
assert abs(beside - 8.9) < 0.1
assert np.allclose(back, [19.0, 11.8, 33.8], atol=0.1)
for order in ('xyz', 'xzy', 'yxz', 'yzx', 'zxy', 'zyx'):
    turned = np.asarray(quaternions.from_angles(angles, order)).ravel()
    assert np.abs(quaternions.to_angles(turned, order) - angles).max() > np.radians(3)
PYTHON

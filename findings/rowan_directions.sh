#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rowan 1.3.2: the derivative of an attitude turns about another axis than its integral, and the way from one attitude
# to another leads away from it.
#
# A flange that is turned by 90° about z turns at 1 rad/s about x. Its documentation defines derivative() as v·q/2, and
# integrate() as exp(v·dt/2)·q, which have the same axes. Expected: derivative() is what integrate() adds in a short
# step. What happens: derivative() is q·v/2, a turn about the x axis of the flange, which is the y axis of the base;
# an integration by it turns the flange at right angles to the way that integrate() takes.
# riemann_log_map(p, q) is documented to point from p to q, and as the inverse of riemann_exp_map(). Expected: from 10°
# to 40°, followed by riemann_exp_map(), leads to 40°. What happens: it leads to -20°, as the log has the other sign.
# For us: take SciPy's Rotation, or multiply [0, v/2] by q, and take the log with p and q exchanged.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check rowan==1.3.2 numpy==2.4.6
cat > "$folder/directions.py" <<'PYTHON'
import numpy as np
import rowan


def about_z(degrees):
    return rowan.from_axis_angle([0, 0, 1], np.deg2rad(degrees))


def angle_about_z(attitude):
    return np.rad2deg(2 * np.arctan2(attitude[3], attitude[0]))


flange, speed, step = about_z(90), np.array([1.0, 0, 0]), 1e-6
integrated = (rowan.calculus.integrate(flange, speed, step) - flange) / step
found = rowan.calculus.derivative(flange, speed)
documented = rowan.multiply([0, *speed / 2], flange)
print('integrate():', integrated.round(3), 'derivative():', found.round(3), 'as documented:', documented.round(3))
assert np.allclose(integrated, documented, atol=1e-5)
assert np.allclose(found, rowan.multiply(flange, [0, *speed / 2])) and not np.allclose(found, documented, atol=0.5)
axis = 2 * rowan.multiply(found, rowan.conjugate(flange))[1:]
print('axis of the turn by derivative(), in the base:', axis.round(3))
assert np.allclose(axis, (0, 1, 0))

start, goal = about_z(10), about_z(40)
way = rowan.geometry.riemann_log_map(start, goal)
end = rowan.geometry.riemann_exp_map(start, way)
print(f'from 10° to 40°: {angle_about_z(end):.6g}°')
assert np.isclose(angle_about_z(end), -20)
other = rowan.geometry.riemann_log_map(goal, start)
assert np.isclose(angle_about_z(rowan.geometry.riemann_exp_map(start, other)), 40)
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/directions.py"

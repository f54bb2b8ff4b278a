#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pymunk 7.3.1: a motor with a rate of 1 rad/s turns its arm at -1 rad/s, against the sign of the limits of its joint.
#
# An arm turns about a fixed body; all constraints are given both bodies in the same order, as (fixed, arm). Expected:
# one sign of the angle between them. What happens: RotaryLimitJoint and GearJoint count the angle of the arm less that
# of the fixed body, SimpleMotor and DampedRotarySpring the opposite. So a motor with a rate of +1 rad/s pushes the arm
# into the lower end of its range from 0 to 2 rad for ever, and a spring with a rest angle of 0.3 rad pulls it to -0.3
# rad. The documentation calls both a relative angle or speed of the two bodies, without a sign.
# For us: give motors and springs the bodies in the order (arm, fixed), limits and gears in the order (fixed, arm).
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pymunk==7.3.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import pymunk


def angle_after(*constraints):
    """The angle of an arm of 1 kg·m² after 3 s, rad."""
    space = pymunk.Space()
    space.gravity = 0, 0
    fixed, arm = space.static_body, pymunk.Body(1, 1)
    space.add(arm, pymunk.PivotJoint(fixed, arm, (0, 0)), *(make(fixed, arm) for make in constraints))
    for _ in range(3000):
        space.step(0.001)
    return arm.angle


def limit(fixed, arm):
    return pymunk.RotaryLimitJoint(fixed, arm, 0, 2)


def motor(fixed, arm):
    made = pymunk.SimpleMotor(fixed, arm, 1)
    made.max_force = 10
    return made


found = {
    'motor at 1 rad/s': angle_after(motor),
    'motor at 1 rad/s, range from 0 to 2': angle_after(motor, limit),
    'motor in the other order, range from 0 to 2': angle_after(lambda fixed, arm: motor(arm, fixed), limit),
    'spring with a rest angle of 0.3': angle_after(
        lambda fixed, arm: pymunk.DampedRotarySpring(fixed, arm, 0.3, stiffness=100, damping=50)
    ),
    'gear with a phase of 0.3': angle_after(lambda fixed, arm: pymunk.GearJoint(fixed, arm, 0.3, ratio=1)),
}
for name, angle in found.items():
    print(name, round(angle, 3))
assert all(abs(angle - right) < 0.06 for angle, right in zip(found.values(), (-3, 0, 2, -0.3, 0.3)))
PYTHON

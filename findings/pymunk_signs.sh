#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pymunk 7.3.1: a spring with a rest angle of 0.5 rad rests at -0.5 rad, and a motor at 1 rad/s turns its shaft at -1
# rad/s.
#
# A shaft turns about a base; each joint is made of (base, shaft). A RotaryLimitJoint from 0 to 1 rad keeps the shaft
# from 0 to 1 rad, and a GearJoint with a phase of 0.5 rad puts it at 0.5 rad, as expected. Expected of
# DampedRotarySpring with a rest_angle of 0.5 rad: 0.5 rad; of SimpleMotor with a rate of 1 rad/s: 1 rad/s. What
# happens: -0.5 rad and -1 rad/s, so that within these limits the spring presses the shaft against its stop at 0, and
# the motor does not move it. The documentation calls the angle of the spring, the speed of the motor and the rotation
# of the limits relative, and does not say to which of the two bodies.
# For us: give springs and motors as (shaft, base), limits and gears as (base, shaft).
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --only-binary :all: pymunk==7.3.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import pymunk


def shaft(joints, torque=0.0):
    """The angle in rad and the speed in rad/s of the shaft after 10 s."""
    space = pymunk.Space()
    base = space.static_body
    body = pymunk.Body(1, 0.1)
    space.add(body, pymunk.PivotJoint(base, body, (0, 0)), *joints(base, body))
    for _ in range(10_000):
        body.torque = torque
        space.step(0.001)
    return body.angle, body.angular_velocity


def spring(base, body):
    return pymunk.DampedRotarySpring(base, body, rest_angle=0.5, stiffness=10, damping=2)


def limits(base, body):
    return pymunk.RotaryLimitJoint(base, body, 0.0, 1.0)


def close(value, expected):
    return abs(value - expected) < 1e-3


pressed = [shaft(lambda *pair: [limits(*pair)], torque)[0] for torque in (1.0, -1.0)]
gear = shaft(lambda *pair: [pymunk.GearJoint(*pair, 0.5, 1.0)])[0]
print('limits 0 and 1 rad:', pressed[::-1], 'gear with a phase of 0.5 rad:', gear)
assert close(pressed[0], 1) and close(pressed[1], 0) and close(gear, 0.5)
rest = shaft(lambda *pair: [spring(*pair)])[0]
stopped = shaft(lambda *pair: [spring(*pair), limits(*pair)])[0]
swapped = shaft(lambda base, body: [spring(body, base), limits(base, body)])[0]
print('spring at 0.5 rad:', rest, 'with limits of 0 and 1 rad:', stopped, 'as (shaft, base):', swapped)
assert close(rest, -0.5) and close(stopped, 0) and close(swapped, 0.5)
speed = shaft(lambda *pair: [pymunk.SimpleMotor(*pair, 1.0)])[1]
print('motor at 1 rad/s:', speed)
assert close(speed, -1)
angle = shaft(lambda base, body: [pymunk.SimpleMotor(base, body, 1.0), limits(base, body)])[0]
print('motor at 1 rad/s with limits of 0 and 1 rad, after 10 s:', angle)
assert close(angle, 0)
PYTHON

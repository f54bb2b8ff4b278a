#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pyplcopen 0.21.0: an axis with limits of ±2 rad, 1 rad/s and 1 rad/s² is at 5 rad/s within 1 ms, and at 40 rad after
# 8 s.
#
# The limits are set with configure_si() and read back with si_config(). Expected of move_velocity() with 5 rad/s and
# 1 rad/s²: an error, or 1 rad/s after 1 s and a stop at 2 rad, as move_absolute(3) is refused as out of range. What
# happens: neither the limits nor the acceleration of the command are used. The speed is 5 rad/s after one cycle of 1
# ms, and from there -5 rad/s one cycle after the next command; the axis passes its limit and turns on, and its status
# is CONTINUOUS_MOTION. Nothing warns.
# For us: check position, speed and acceleration of each command before it is given.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pyplcopen==0.21.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import pyplcopen

CYCLE = pyplcopen.CycleConfig.at_1khz()
ACCELERATION, JERK = CYCLE.acceleration_to_cycle(1.0), CYCLE.jerk_to_cycle(100.0)
LIMITS = {
    'max_velocity': 1.0,
    'max_acceleration': 1.0,
    'max_deceleration': 1.0,
    'max_jerk': 100.0,
    'max_position': 2.0,
    'min_position': -2.0,
    'max_position_enabled': True,
    'min_position_enabled': True,
}


def limited_axis():
    axis = pyplcopen.AxisSim()
    config = axis.si_config(CYCLE)
    for name, value in LIMITS.items():
        setattr(config, name, value)
    axis.configure_si(CYCLE, config)
    assert all(getattr(axis.si_config(CYCLE), name) == value for name, value in LIMITS.items())
    axis.power_on()
    return axis


def turn(axis, speed):
    """Return the speed after one cycle of a move at this speed in rad/s."""
    axis.move_velocity(CYCLE.velocity_to_cycle(speed), ACCELERATION, ACCELERATION, JERK)
    return round(CYCLE.velocity_to_si(axis.command_velocity()), 3)


axis = limited_axis()
try:
    axis.move_absolute(3.0, CYCLE.velocity_to_cycle(0.5), ACCELERATION, ACCELERATION, JERK)
except RuntimeError as error:
    print(error)
else:
    raise AssertionError('move_absolute() went beyond the limit')
speeds = [turn(axis, 5.0)]
axis.cycle(8000)
reached = round(axis.command_position(), 1)
speeds.append(turn(axis, -5.0))
print('after one cycle', speeds, 'rad/s; after 8 s at', reached, 'rad,', axis.status())
assert speeds == [5.0, -5.0] and reached == 40.0
PYTHON

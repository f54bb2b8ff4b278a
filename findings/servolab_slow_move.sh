#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# servolab 1.0.0: a move whose greatest speed is 0 or 0.0007 rad/s runs at the full speed of the servo.
#
# Expected of move_to(1.0, speed=0.0007): the servo creeps, or the speed is refused, for only None is documented to
# mean "as fast as possible". What happens: the speed is rounded to whole steps per second (4096 a turn), so that each
# speed below 0.00077 rad/s becomes 0, which the register of the servo takes as "no limit". Within 2 s the servo is at
# its goal, 1 rad away. At 0.0016 rad/s (1 step per second) it creeps. The servo here is the simulated one of the
# library; what move_to() writes into the register is the same for a real one.
# For us: before a move, take speeds below 0.001 rad/s as a stop, or command the creep as goal positions.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check servolab==1.0.0 numpy==2.3.5 pyserial==3.5
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import time

import servolab

bus = servolab.connect('sim')
motor = bus[1]
motor.mode = 'position'
motor.torque_enabled = True
registers, turned = {}, {}
for speed in (0.0016, 0.0007, 0.0):
    motor.move_to(0.0)
    time.sleep(2.0)
    motor.move_to(1.0, speed=speed)
    registers[speed] = motor.read_register('goal_velocity')
    time.sleep(2.0)
    turned[speed] = round(motor.position, 2)
print('goal_velocity', registers, 'turned within 2 s', turned)
assert registers == {0.0016: 1, 0.0007: 0, 0.0: 0}
assert abs(turned[0.0016]) < 0.02 and turned[0.0007] > 0.9 and turned[0.0] > 0.9
PYTHON

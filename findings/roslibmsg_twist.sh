#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# roslibmsg 0.4.2: the new Twist() that is to stop a robot drives it on at 0.5 m/s, as the one before had been set to.
#
# Expected of Twist() and Odometry(), as of the messages of rclpy: all speeds are 0. What happens: each Twist that is
# made without arguments has the same two vectors, which are the defaults of its constructor, so that `move.linear.x =
# 0.5` sets them for all messages before and after: a second robot on another topic gets 0.5 m/s too, and
# dict(Twist()), which is what roslibpy publishes, has 0.5 m/s. The speeds of an Odometry that is not moving are those
# of another one. Poses are right: a new one is at 0.
# For us: make the vectors, Twist(Vector3(), Vector3()), for each message.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check roslibmsg==0.4.2 roslibpy==2.1.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from roslibmsg.nav_msgs import Odometry, Twist, Vector3

other = Twist()
move = Twist()
move.linear.x = 0.5
found = {'other': other, 'move': move, 'stop': Twist(), 'own': Twist(Vector3(), Vector3())}
found = {name: dict(message)['linear']['x'] for name, message in found.items()}
arm, base = Odometry(), Odometry()
base.twist.twist.angular.z, base.pose.pose.position.x = 2.0, 3.0
read = dict(arm)
found['turning'] = read['twist']['twist']['angular']['z']
found['position'] = read['pose']['pose']['position']['x']
print('speeds and position:', found)
assert found == {'other': 0.5, 'move': 0.5, 'stop': 0.5, 'own': 0.0, 'turning': 2.0, 'position': 0.0}, found
PYTHON

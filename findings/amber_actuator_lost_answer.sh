#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# amber-actuator 0.1.0: an actuator at 190° that is to turn by 10° is sent to 9° if one datagram is lost, and its angle
# is read as that of another actuator.
#
# rotate(10) asks for the angle over UDP and sends it with 10 added. Expected where no answer comes: an error, or no
# move. What happens: after a second the answer is given as -1, which is taken for an angle, so that the goal is 9° and
# the actuator turns back by 181°. position.now is then -1 as well, as at an actuator that stands at -1°. The number of
# the actuator, with which each answer begins, is not looked at: what actuator 2 sends late, 45°, is read as the angle
# of actuator 1. Nothing warns. A socket that answers takes the place of the actuators.
# For us: read position.now several times, and send the goal by rotate_to() only where the readings agree.
#
# Exit code 0: still so. Installs the version into a temporary folder; uses the UDP ports 12321 and 24001.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check amber-actuator==0.1.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import socket
import struct
import threading

from amber_actuator import AmberActuator

READ_ANGLE, GOAL = 10, 11
angles = {1: 190.0, 2: 45.0}
goals = []
lose = False
answer_as = 1
port = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
port.bind(('127.0.0.1', 24001))


def serve():
    while True:
        data, address = port.recvfrom(100)
        number, write, command, value = struct.unpack('<BBBf', data)
        if write:
            assert command == GOAL
            goals.append((number, value))
        elif lose:
            continue
        port.sendto(struct.pack('<BBBf', answer_as, write, command, angles[answer_as]), address)


threading.Thread(target=serve, daemon=True).start()
actuator = AmberActuator(1)
actuator.rotate(10)
seen = [actuator.position.now]
lose = True
actuator.rotate(10)
seen.append(actuator.position.now)
lose, answer_as = False, 2
seen.append(actuator.position.now)
print('goals', goals, 'and angles', seen)
assert goals == [(1, 200.0), (1, 9.0)] and seen == [190.0, -1, 45.0]
PYTHON

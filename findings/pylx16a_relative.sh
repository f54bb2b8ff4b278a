#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pylx16a 1.1.1: a servo with limits of 60° and 180° refuses to turn by 10°, or back, but turns from 170° by 70° to
# 240°.
#
# Expected of move(10, relative=True) at 100°: a command to 110°, and of move(70, relative=True) at 170° an error, since
# the limits end at 180°. What happens: not the goal but the number of degrees to turn is compared with the limits, so
# that 10 is refused as less than 60, -10 also without limits, as less than 0, and 70 is sent as 240°.
# get_angle_offset() of an offset of -10° that was set gives 51.36° until the program is started anew.
# For us: add the angle of get_commanded_angle() in the driver, and send absolute goals.
#
# A pseudo-terminal answers as the servo does. Exit code 0: still so. Installs the package into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pylx16a==1.1.1 pyserial==3.5
cat > "$folder/servo.py" <<'PYTHON'
import os
import pty
import threading
import tty

from pylx16a.lx16a import LX16A, ServoArgumentError

COUNTS = 1000 / 240
limits = [round(60 * COUNTS), round(180 * COUNTS)]
goals = []
position = 0


def two(number):
    return [number % 256, number // 256]


def answer(terminal):
    pending = b''
    while True:
        pending += os.read(terminal, 64)
        while len(pending) >= 4 and len(pending) >= pending[3] + 3:
            message, pending = pending[: pending[3] + 3], pending[pending[3] + 3 :]
            command, data = message[4], message[5:-1]
            if command == 1:
                goals.append(int.from_bytes(data[:2], 'little') / COUNTS)
            content = {
                19: [0],
                21: two(limits[0]) + two(limits[1]),
                23: two(4500) + two(12000),
                25: [85],
                28: two(position),
                30: [0, 0, 0, 0],
                32: [1],
                34: [0],
                36: [7],
            }.get(command)
            if content is not None:
                body = [message[2], len(content) + 3, command, *content]
                os.write(terminal, bytes([0x55, 0x55, *body, ~sum(body) % 256]))


bus, host = pty.openpty()
tty.setraw(bus)
tty.setraw(host)
threading.Thread(target=answer, args=(bus,), daemon=True).start()
LX16A.initialize(os.ttyname(host), timeout=2.0)


def turned(angle, degrees):
    global position
    position = round(angle * COUNTS)
    servo = LX16A(1)
    goals.clear()
    try:
        servo.move(degrees, relative=True)
    except ServoArgumentError as error:
        print('at', angle, 'by', degrees, '-', error)
        return None
    servo.get_physical_angle()
    print('at', angle, 'by', degrees, '- sent to', [round(goal, 1) for goal in goals])
    return goals[-1]


assert turned(100, 10) is None
assert abs(turned(170, 70) - 240) < 0.3
limits = [0, 1000]
assert abs(turned(100, 10) - 110) < 0.3
assert turned(100, -10) is None
servo = LX16A(1)
servo.set_angle_offset(-10)
print('offset', servo.get_angle_offset())
assert abs(servo.get_angle_offset() - 51.36) < 0.01
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/servo.py"

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# cybergear-core 0.1.0: a command to hold 0 rad with 30 N·m/rad is sent as 12.5 rad, 29.9 rad/s and 180 N·m/rad.
#
# A frame of motion has four words: angle, speed, stiffness and damping. By the manual of the CyberGear the high byte of
# each comes first, as it does in the motor's answers, which this library reads so. Expected of
# send_motor_control_command(target_angle=0): the word 0x7fff, the middle of ±4π rad. What happens: the words are packed
# in the order of the computer, low byte first on x86 and ARM. The motor takes 0 rad as 12.52 rad, 1 rad as -7.90 rad,
# and a stiffness of 30 N·m/rad as 180 N·m/rad: it turns by two turns as fast as it can. The torque is right, since it
# is in the identifier; so are the parameters of the position mode.
# For us: use set_motor_position_control(), or python-cybergear 0.1.2 for this frame.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check cybergear-core==0.1.0 python-can==4.6.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import math
import struct

import can
from cybergear import CANMotorController
from loguru import logger

logger.remove()
ENDS = (-4 * math.pi, 4 * math.pi), (-30, 30), (0, 500), (0, 5)


def taken(data):
    """What a motor takes from a frame of motion: rad, rad/s, N·m/rad and N·m·s/rad."""
    words = struct.unpack('>4H', data)
    return [round(least + word / 65535 * (most - least), 2) for word, (least, most) in zip(words, ENDS)]


with can.Bus('bus', interface='virtual') as host, can.Bus('bus', interface='virtual') as drive:
    motor = CANMotorController(host)
    found = []
    for angle, speed, stiffness in ((0, 0, 30), (1, 2, 30)):
        drive.send(can.Message(arbitration_id=0x0280_7FFE, data=struct.pack('>4H', 40000, 32767, 32767, 250)))
        _, position, _, _ = motor.send_motor_control_command(0, angle, speed, stiffness, 1)
        found.append(taken(drive.recv(1).data))
        print('sent', [angle, speed, stiffness, 1], 'taken', found[-1], 'read', round(position, 2))
        assert abs(position - (40000 / 65535 * 25 - 12.5)) < 1e-3
    assert found == [[12.52, 29.88, 179.8, 1.0], [-7.9, 2.0, 179.8, 1.0]]
    drive.send(can.Message(arbitration_id=0x0280_7FFE, data=bytes(8)))
    del motor
PYTHON

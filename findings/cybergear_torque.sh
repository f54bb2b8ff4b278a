#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pycybergear 1.0.0: each command of motion has a torque of -12 N·m, whatever torque is given.
#
# Expected of send_motion_command(torque=0): the 16 bits of the identifier that carry the torque are 32767, which is 0
# of ±12 N·m. What happens: the torque is computed, but not sent. The address of the host, which is 0 unless given, is
# in its place, and as a torque 0 is -12 N·m, all that a CyberGear has. A position of 13 rad, beyond the ±12.5 rad of
# the frame, is sent as -12.
# For us: python-cybergear 0.1.2 and cybergeardriver 0.2.0 send the torque; keep positions within ±12.5 rad.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pycybergear==1.0.0 python-can==4.6.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct

import can
from cybergear import CyberGear


def physical(counts, end):
    return round(counts / 65535 * 2 * end - end, 2)


bus = CyberGear(interface='virtual', channel='bus')
with can.Bus('bus', interface='virtual') as drive:
    motor = bus.init_motor(0x7F)
    drive.recv(1)  # the motor's reset
    for torque, position, expected in ((0, 1, 1), (5, 1, 1), (12, 13, -12)):
        motor.send_motion_command(position=position, speed=0, torque=torque, kp=10, kd=1)
        sent = drive.recv(1)
        counts = struct.unpack('>H', sent.data[:2])[0]
        read = physical(sent.arbitration_id >> 8 & 0xFFFF, 12), physical(counts, 12.5)
        print('torque', torque, 'and position', position, 'are sent as', read)
        assert read == (-12, expected)
bus.close()
PYTHON

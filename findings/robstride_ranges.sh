#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# robstride-dynamics 0.0.1: a torque of 2 N·m is sent to an RS05 as 0.65 N·m, and an RS03 at 8 rad/s is read at 20
# rad/s.
#
# Each frame of a RobStride motor has torque and speed as fractions of the motor's own range, so that both sides have to
# know it. By the manuals, and by epicallypowerful 1.0.7, the ranges are 14 N·m and 33 rad/s in an RS00, 20 rad/s in an
# RS03, 5.5 N·m and 50 rad/s in an RS05, 36 N·m and 50 rad/s in an RS06. What happens: this package takes 17 and 50, 50,
# 17 and 33, 60 and 20. RS01, RS02 and RS04 are right, and so are the gains and angles of all.
# For us: scale by the factors that are printed here; a speed can be checked against the angles.
#
# Exit code 0: still so. Installs the packages into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" # epicallypowerful writes a log where it is started
python3 -m venv venv
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 python-can==4.6.1 scipy==1.17.1 smbus2==0.6.1 \
    tqdm==4.67.1 msgspec==0.22.0
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps epicallypowerful==1.0.7 robstride-dynamics==0.0.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct

import can
from epicallypowerful.actuation.motor_data import MOTOR_PARAMS
from robstride_dynamics import bus as robstride


class Motor:
    """Answers each command with this speed and torque, and keeps the torque that it is given."""

    def __init__(self, model, speed, torque):
        self.limits = MOTOR_PARAMS[model]
        self.status = speed, torque

    def send(self, frame):
        share = (frame.arbitration_id >> 8 & 0xFFFF) / 0x7FFF - 1
        self.torque = share * self.limits['torque_limits'][1]

    def recv(self, timeout=None):
        ranges = self.limits['velocity_limits'][1], self.limits['torque_limits'][1]
        speed, torque = (round((value / most + 1) * 0x7FFF) for value, most in zip(self.status, ranges))
        data = struct.pack('>HHHH', 0x7FFF, speed, torque, 250)
        return can.Message(arbitration_id=0x020001FF, is_extended_id=True, data=data)


found = {}
for number in range(7):
    motor = Motor(f'RS0{number}', 8, 2)
    bus = robstride.RobstrideBus('', {'joint': robstride.Motor(1, f'rs-0{number}')})
    bus.channel_handler = motor
    position, speed, torque, temperature = bus.receive_status_frame('joint')
    bus.write_operation_frame('joint', 0, kp=0, kd=0, torque=2)
    bus.channel_handler = None
    found[f'RS0{number}'] = round(float(speed), 1), round(float(torque), 1), round(float(motor.torque), 2)
    print(f'RS0{number} at 8 rad/s and 2 N·m: read', found[f'RS0{number}'][:2], 'a command of 2 N·m is', found[f'RS0{number}'][2])
assert all(found[model] == (8.0, 2.0, 2.0) for model in ('RS01', 'RS02', 'RS04'))
assert found['RS00'] == (12.1, 2.4, 1.65) and found['RS03'] == (20.0, 2.0, 2.0)
assert found['RS05'] == (5.3, 6.2, 0.65) and found['RS06'] == (3.2, 3.3, 1.2)
PYTHON

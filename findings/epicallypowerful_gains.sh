#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# epicallypowerful 1.0.7: a stiffness of 50 N·m/rad is sent to an RS03, RS04 or RS06 as 500 N·m/rad, a damping of 2 as
# 40.
#
# In the frames of these RobStride motors the gains have ranges of 0 to 5000 N·m/rad and 0 to 100 N·m·s/rad, in smaller
# motors of 0 to 500 and 0 to 5. create_motion_message() scales all of them by the smaller ranges, although the class's
# own kp_limits and kd_limits have the right ones. robstride-dynamics 0.0.1 sends the same gains in a frame that is
# right. A parameter that is read, such as the position 0x7019, is taken as a big-endian integer: 1.5 rad is 49215. All
# motors share one dictionary of such parameters.
# For us: give a tenth of the stiffness and a twentieth of the damping to such a motor, and read angles from its status.
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
from epicallypowerful.actuation.robstride.robstride import Robstride
from robstride_dynamics import bus as robstride


class Frames(list):
    def send(self, frame, timeout=None):
        self.append(frame)

    def recv(self, timeout=None):  # the answer to each command: at rest, 25 °C
        data = struct.pack('>HHHH', 0x7FFF, 0x7FFF, 0x7FFF, 250)
        return can.Message(arbitration_id=0x020001FF, is_extended_id=True, data=data)


def gains(frame, stiffest, most_damped):
    stiffness, damping = struct.unpack('>4xHH', frame.data)
    return round(stiffness / 0xFFFF * stiffest, 1), round(damping / 0xFFFF * most_damped, 1)


for model, other, ranges, received in (
    ('RS02', 'rs-02', (500, 5), (50, 2)),
    ('RS03', 'rs-03', (5000, 100), (500, 40)),
    ('RS04', 'rs-04', (5000, 100), (500, 40)),
    ('RS06', 'rs-06', (5000, 100), (500, 40)),
):
    motor = Robstride(1, model)
    motor._bus = Frames()
    motor.set_position(0.5, kp=50, kd=2)
    peer = robstride.RobstrideBus('', {'joint': robstride.Motor(1, other)})
    peer.channel_handler = Frames()
    peer.write_operation_frame('joint', 0.5, kp=50, kd=2)
    frames = motor._bus[0], peer.channel_handler[0]
    peer.channel_handler = None
    print(model, 'limits', motor.data.kp_limits, motor.data.kd_limits, 'sent', *(gains(frame, *ranges) for frame in frames))
    assert (motor.data.kp_limits[1], motor.data.kd_limits[1]) == ranges
    assert [gains(frame, *ranges) for frame in frames] == [received, (50, 2)]
motor, second = Robstride(1, 'RS03'), Robstride(2, 'RS03')
position = can.Message(arbitration_id=0x11000100, is_extended_id=True, data=struct.pack('<HHf', 0x7019, 0, 1.5))
motor.on_message_received(position)
print('parameter of the first motor', motor.data.internal_params, 'of the second', second.data.internal_params)
assert motor.data.internal_params[0x7019] == second.data.internal_params[0x7019] == 49215
PYTHON

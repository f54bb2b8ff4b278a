#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# lerobot 0.6.1: a RobStride RS06 at 57° is read at 513°, and a stiffness of 50 N·m/rad is sent to it as 500.
#
# Each frame of a RobStride motor has its values as fractions of the motor's own ranges. By epicallypowerful 1.0.7 and
# robstride-dynamics 0.0.1, the angle of each model goes to ±12.57 rad, and the gains of an RS03, RS04 and RS06 go to
# 5000 N·m/rad and 100 N·m·s/rad. What happens: the angle of an "O6" goes to 112.5 here, so that a goal of 57° is sent
# as 6°; the gains of all models go to 500 and 5, so that a damping of 2 is sent to those three as 40; and the speed of
# an "O2", "O3" and "O4" goes to 33 rad/s instead of 44, 20 and 15 by epicallypowerful: 458°/s, which are 8 rad/s, are
# read as 344, 756 and 1008°/s. Each read of a motor is the command that the package itself names CLEAR_FAULT.
# For us: give a tenth of the stiffness and a twentieth of the damping to these three, and do not use an O6.
#
# Exit code 0: still so. Installs the packages into a temporary folder, without torch, which the motors do not use: the
# modules that need it are replaced, and two statements are written as Python 3.11 has them.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" # epicallypowerful writes a log where it is started
python3 -m venv venv
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check numpy==2.2.6 deepdiff==8.6.1 tqdm==4.67.1 \
    draccus==0.11.6 packaging==25.0 python-can==4.6.1 scipy==1.17.1 smbus2==0.6.1 msgspec==0.22.0
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps --ignore-requires-python \
    lerobot==0.6.1 epicallypowerful==1.0.7 robstride-dynamics==0.0.1
sed -i 's/^type \([A-Za-z]*\) =/\1 =/' venv/lib/python3*/site-packages/lerobot/motors/motors_bus.py
cat > read.py <<'PYTHON'
import math
import struct
import sys
from types import SimpleNamespace

names = ('auto_select_torch_device', 'get_safe_torch_device', 'is_torch_device_available')
sys.modules['lerobot.utils.device_utils'] = SimpleNamespace(**dict.fromkeys(names))
sys.modules['lerobot.utils.utils'] = SimpleNamespace(enter_pressed=None, move_cursor_up=None)
sys.modules['huggingface_hub'] = sys.modules['huggingface_hub.constants'] = SimpleNamespace(HF_HOME='')

import can
from epicallypowerful.actuation.motor_data import MOTOR_PARAMS
from lerobot.motors import Motor, MotorNormMode
from lerobot.motors.robstride import RobstrideMotorsBus
from lerobot.motors.robstride.tables import CAN_CMD_CLEAR_FAULT
from robstride_dynamics import table


class Drive:
    """A motor at 1 rad and 8 rad/s that answers each command, and keeps what it is told."""

    def __init__(self, model):
        limits = MOTOR_PARAMS[model]
        kinds = 'position', 'velocity', 'kp', 'kd', 'torque'
        self.most = dict(zip(kinds, (limits[f'{kind}_limits'][1] for kind in kinds)))
        self.commands, self.goal, self.answers = [], None, []

    def fraction(self, kind, raw, bits):
        return raw / (2**bits - 1) * self.most[kind]

    def send(self, frame):
        packed = int.from_bytes(frame.data, 'big')
        self.commands.append(frame.data[7])
        if frame.data[:7] != b'\xff' * 7:
            angle = self.fraction('position', packed >> 48, 16) * 2 - self.most['position']
            stiffness = self.fraction('kp', packed >> 24 & 4095, 12)
            damping = self.fraction('kd', packed >> 12 & 4095, 12)
            self.goal = round(math.degrees(angle)), round(stiffness), round(damping)
        angle, speed = (1 / self.most['position'] + 1) / 2, (8 / self.most['velocity'] + 1) / 2
        state = round(angle * 65535) << 24 | round(speed * 4095) << 12 | 2047
        data = b'\x01' + state.to_bytes(5, 'big') + struct.pack('>H', 250)
        self.answers.append(can.Message(arbitration_id=1, data=data))

    def recv(self, timeout=None):
        return self.answers.pop() if self.answers else None


found = {}
for number in range(7):
    drive = Drive(f'RS0{number}')
    joint = Motor(1, 'robstride', MotorNormMode.DEGREES, motor_type_str=f'O{number}', recv_id=1)
    bus = RobstrideMotorsBus('', {'joint': joint})
    bus.canbus, bus._is_connected = drive, True
    states = bus.sync_read_all_states()['joint']
    assert drive.commands == [CAN_CMD_CLEAR_FAULT]
    bus.write('Kp', 'joint', 50.0)
    bus.write('Kd', 'joint', 2.0)
    bus.write('Goal_Position', 'joint', math.degrees(1))
    found[f'O{number}'] = round(float(states['position'])), round(float(states['velocity'])), *drive.goal
    bus._is_connected = False
    print(f'O{number} at 57° and 458°/s: read', found[f'O{number}'][:2], 'sent 57°, 50, 2:', found[f'O{number}'][2:])
tables = table.MODEL_MIT_POSITION_TABLE, table.MODEL_MIT_KP_TABLE, table.MODEL_MIT_KD_TABLE
ranges = [tuple(round(float(kind[f'rs-0{number}']), 2) for kind in tables) for number in range(7)]
print('Ranges by robstride-dynamics:', ranges)
assert ranges == [(12.57, 500, 5)] * 3 + [(12.57, 5000, 100)] * 2 + [(12.57, 500, 5), (12.57, 5000, 100)]
right = (57, 458, 57, 50, 2)
assert found == {
    'O0': right, 'O1': (57, 459, *right[2:]), 'O2': (57, 344, *right[2:]), 'O3': (57, 756, 57, 499, 40),
    'O4': (57, 1008, 57, 499, 40), 'O5': right, 'O6': (513, 458, 6, 499, 40),
}  # fmt: skip
PYTHON
timeout 60 venv/bin/python read.py

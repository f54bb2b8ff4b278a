#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# uc2canopen 0.2.3: the position of the second axis of a node is that of the first, and a moving axis counts as idle.
#
# Expected of get_position(axis=1), where axis is the "axis index on the slave (0-3)": the position of the second axis,
# 4000 steps. What happens: the last position that the node sent for its first axis is given, 100 steps, for each axis,
# unless it is older than two seconds; only then is the axis asked. is_running(axis=1) is False and
# wait_for_idle(axis=1) is True at once in the same way, while the second axis moves and the first one stands still.
# get_homing_status() tells the axes apart. A node on a virtual bus answers by the object dictionary of the package.
# For us: read the position and the status of each axis but the first by SDO.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check uc2canopen==0.2.3 python-can==4.6.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct
import time

import can
from uc2canopen import UC2Client
from uc2canopen.od import OD

NODE = 11
POSITIONS, MOVING = (100, 4000), (0, 1)  # of the two axes of the node
open_bus = can.interface.Bus
can.interface.Bus = lambda **_: open_bus(interface='virtual', channel='uc2')
node_bus = open_bus(interface='virtual', channel='uc2')
asked = []


def answer(message):
    if message.arbitration_id != 0x600 + NODE or message.data[0] != 0x40:
        return
    index, sub = struct.unpack_from('<HB', message.data, 1)
    asked.append((index, sub))
    values = {OD.MOTOR_ACTUAL_POSITION: POSITIONS, OD.MOTOR_STATUS_WORD: MOVING}[index]
    size = {OD.MOTOR_ACTUAL_POSITION: 0x43, OD.MOTOR_STATUS_WORD: 0x4F}[index]
    data = struct.pack('<BHBi', size, index, sub, values[sub - 1])
    node_bus.send(can.Message(arbitration_id=0x580 + NODE, data=data, is_extended_id=False))


notifier = can.Notifier(node_bus, [answer])
uc2 = UC2Client(interface='socketcan')
motor = uc2.motor
axes = [(motor.get_position(axis=axis, node_id=NODE), motor.is_running(axis=axis, node_id=NODE)) for axis in (0, 1)]
print('before the node has sent its state:', axes)
assert axes == [(100, False), (4000, True)]
asked.clear()
state = struct.pack('<iBB', POSITIONS[0], MOVING[0], 0)
node_bus.send(can.Message(arbitration_id=0x180 + NODE, data=state, is_extended_id=False))
deadline = time.time() + 20
while uc2._listener.get_motor(NODE) is None and time.time() < deadline:
    time.sleep(0.01)
axes = [(motor.get_position(axis=axis, node_id=NODE), motor.is_running(axis=axis, node_id=NODE)) for axis in (0, 1)]
idle = motor.wait_for_idle(axis=1, node_id=NODE)
print('after it:', axes, '- idle:', idle, '- asked:', asked)
notifier.stop()
uc2.close()
node_bus.shutdown()
assert axes == [(100, False), (100, False)] and idle is True and asked == []
PYTHON

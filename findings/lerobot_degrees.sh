#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# lerobot 0.4.4: in degrees, a servo whose calibration reverses it is not reversed, and a turn has 360.09 degrees.
#
# The calibration of a Feetech servo has drive_mode 1, which reverses it, and the range 1000 to 3000. At a position of
# 2500 the bus reads -50 if it normalizes to ±100, which observes drive_mode, but +43.956 in degrees, where -43.945 is
# expected: drive_mode is ignored, and 4096 counts of a turn are divided by 4095. Beyond its range, at 3500, the
# normalized position stays at -100, while that in degrees goes on. A pseudo-terminal answers here as a servo does.
# For us: reverse such a joint after it is read; do not take a normalized position at ±100 for a standstill.
#
# Exit code 0: still so. Installs the version into a temporary folder, without torch, which the motors do not use:
# two functions of the module that imports it, which read the keyboard, are replaced.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    numpy==2.2.6 deepdiff==8.6.1 tqdm==4.67.1 draccus==0.10.0 pyserial==3.5 feetech-servo-sdk==1.0.0
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps lerobot==0.4.4
cd "$folder"
cat > read.py <<'PYTHON'
import os
import pty
import sys
import threading
import tty
from types import SimpleNamespace

sys.modules['lerobot.utils.utils'] = SimpleNamespace(enter_pressed=None, move_cursor_up=None)

from lerobot.motors import Motor, MotorCalibration, MotorNormMode
from lerobot.motors.feetech import FeetechMotorsBus

POSITION = 56
registers = bytearray(256)
device, host = pty.openpty()
tty.setraw(device)
tty.setraw(host)


def answer():
    while True:
        request = os.read(device, 256)
        content = bytes(registers[request[5] : request[5] + request[6]])
        status = bytes([request[2], len(content) + 2, 0]) + content
        os.write(device, b'\xff\xff' + status + bytes([~sum(status) & 0xFF]))


threading.Thread(target=answer, daemon=True).start()
found = {}
for mode in MotorNormMode.RANGE_M100_100, MotorNormMode.DEGREES:
    calibration = MotorCalibration(id=1, drive_mode=1, homing_offset=0, range_min=1000, range_max=3000)
    bus = FeetechMotorsBus(os.ttyname(host), {'joint': Motor(1, 'sts3215', mode)}, {'joint': calibration})
    bus.connect(handshake=False)
    for position in 2500, 3500:
        registers[POSITION : POSITION + 2] = position.to_bytes(2, 'little')
        found[mode.value, position] = bus.read('Present_Position', 'joint')
    bus.port_handler.closePort()
print(found)
normalized, degrees = list(found.values())[:2], list(found.values())[2:]
assert normalized == [-50, -100]
assert all(abs(angle - turns * 360 / 4095) < 1e-9 for angle, turns in zip(degrees, (500, 1500)))
PYTHON
timeout 60 venv/bin/python read.py

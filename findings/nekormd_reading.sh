#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# NekoRMD 0.2.2: reading an RMD motor's temperature stops the motor, and a speed of -6 is read as 65530.
#
# Expected of read_motor_temperature_and_torque(): the command 0x9C, which reads the motor's state. What happens: 0xA2
# with zeros is sent, byte for byte the command of set_speed(0), so that a motor in motion is braked by each reading. In
# its answer the current, the speed and the angle are taken without a sign, and the temperature likewise.
# For us: nothing must be written to a drive that is only watched; read 0x9C and unpack it as '<bhhh'.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps NekoRMD==0.2.2
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct
import sys
import types

sys.modules['can'] = types.ModuleType('can')  # the bus is replaced below

from NekoRMD.Control import Control  # noqa: E402
from NekoRMD.MotorType import MotorType  # noqa: E402
from NekoRMD.Telemetry import Telemetry  # noqa: E402

ADDRESS = 0x141
sent = []


class Bus:
    def send_cmd(self, message, delay):
        sent.append(message)
        data = struct.pack('<Bbhhh', message[0], -3, -150, -6, -90)
        return types.SimpleNamespace(arbitration_id=ADDRESS, data=data)


read = Telemetry(MotorType.OTHER, Bus(), ADDRESS).read_motor_temperature_and_torque()
Control(MotorType.OTHER, Bus(), ADDRESS).speed.set_speed(0)
print('read', [hex(byte) for byte in sent[0]], 'stop', [hex(byte) for byte in sent[1]], read)
assert sent[0] == sent[1] == [0xA2, 0, 0, 0, 0, 0, 0, 0]
assert read == {'Temp': 253, 'Iq': 65386, 'Speed': 65530, 'Angle': 65446}
PYTHON

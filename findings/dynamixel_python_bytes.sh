#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# dynamixel-python 0.0.8: in protocol 1.0 a position of 2048 is read as 8.
#
# Registers of two bytes, such as Present Position of the MX-28 (36), have the low byte first. dxl2.v1 writes them so,
# but MotorBus.read takes the first byte as the high one: 0x0800 is read as 0x0008, and a servo that turns slowly
# seems to move in steps of 256. Dynamixel SDK 4.1.0 reads 2048. dxl2.v2, for protocol 2.0, is right.
# A pseudo-terminal answers here as a servo does.
# For us: a recording of such a driver cannot be unwrapped; it shows no sensible speed.
#
# Exit code 0: still so. Installs the packages into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check dynamixel-python==0.0.8 dynamixel-sdk==4.1.0
cat > "$folder/read.py" <<'PYTHON'
import os
import pty
import threading
import tty

from dxl2.v1 import MotorBus
from dynamixel_sdk import PacketHandler, PortHandler


def servo(registers):
    def answer(terminal):
        while True:
            request = os.read(terminal, 256)
            number, address, length = request[2], request[5], request[6]
            content = bytes(registers[address + offset] for offset in range(length))
            status = bytes([number, length + 2, 0]) + content
            os.write(terminal, b'\xff\xff' + status + bytes([~sum(status) & 0xFF]))

    device, host = pty.openpty()
    tty.setraw(device)
    tty.setraw(host)
    threading.Thread(target=answer, args=(device,), daemon=True).start()
    return os.ttyname(host)


registers = bytearray(256)
registers[36:38] = (2048).to_bytes(2, 'little')
bus = MotorBus(servo(registers))
bus.connect()
position = bus.read(1, 36, 2)
port = PortHandler(servo(registers))
assert port.openPort()
by_sdk, *status = PacketHandler(1.0).read2ByteTxRx(port, 1, 36)
print('dynamixel-python', position.data, 'dynamixel-sdk', by_sdk)
assert (position.ok, position.data) == (True, 8)
assert (by_sdk, status) == (2048, [0, 0])
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/read.py"

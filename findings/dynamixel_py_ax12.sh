#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# dynamixel-py 0.0.5: the angles of an AX-12 are 1.2 times too large, and a goal of 150° is sent as 125°.
#
# By ROBOTIS' manual the positions 0 to 1023 of an AX-12 are 0° to 300°, and 60° of its turn have no position. Servo
# takes 512 as 180°: the end of the range is read as 359.6°, and each goal is reached a sixth too early.
# The table AX12 is the only one of 1024 positions. A pseudo-terminal answers here as a servo does.
# For us: a gear behind such a servo seems to have 1.2 times its ratio; multiply the angles by 300/360.
#
# Exit code 0: still so. Installs the packages into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check dynamixel-py==0.0.5 dynamixel-sdk==4.1.0
cat > "$folder/read.py" <<'PYTHON'
import os
import pty
import threading
import tty

from dynamixel_py.dynamixel_handler import DxlComm, Servo

registers = bytearray(64)


def answer(terminal):
    while True:
        request = os.read(terminal, 256)
        number, instruction, address = request[2], request[4], request[5]
        content = b''
        if instruction == 2:
            content = bytes(registers[address : address + request[6]])
        else:
            registers[address : address + len(request) - 7] = request[6:-1]
        status = bytes([number, len(content) + 2, 0]) + content
        os.write(terminal, b'\xff\xff' + status + bytes([~sum(status) & 0xFF]))


device, host = pty.openpty()
tty.setraw(device)
tty.setraw(host)
threading.Thread(target=answer, args=(device,), daemon=True).start()
line = DxlComm(os.ttyname(host))
servo = Servo(1, 'AX12', 1)
for position, angle in ((512, 180.0), (1023, 359.648)):
    registers[36:38] = position.to_bytes(2, 'little')
    read = servo.get_position()
    print('position', position, 'read as', read, 'manual', position * 300 / 1023)
    assert abs(read - angle) < 1e-3
servo.set_position(150.0)
sent = int.from_bytes(registers[30:32], 'little')
print('goal of 150 sent as', sent, 'which is', sent * 300 / 1023)
assert sent == 426
assert abs(sent * 300 / 1023 - 124.9) < 0.1
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/read.py"

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# Dynamixel SDK 4.1.0 for Python: a position of -1 is read as 4294967295.
#
# Registers such as Present Position (132, four bytes) and Present Current (126, two bytes) are signed
# in the control tables, yet read4ByteTxRx, read2ByteTxRx and GroupSyncRead.getData return them as
# unsigned numbers. A servo that turns back through zero in extended position mode jumps by 2^32 counts.
# A pseudo-terminal answers here as a servo does in protocol 2.0, with -1 and -5.
# For us: a driver made with it needs a conversion; a recording that lacks it steps by 2^32 counts.
#
# Exit code 0: still so. Installs dynamixel-sdk into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check dynamixel-sdk==4.1.0
cat > "$folder/servo.py" <<'PYTHON'
import os
import pty
import struct
import threading
import tty

from dynamixel_sdk import GroupSyncRead, PacketHandler, PortHandler

REGISTERS = {132: struct.pack('<i', -1), 126: struct.pack('<h', -5)}


def checksum(data):
    value = 0
    for byte in data:
        value ^= byte << 8
        for _ in range(8):
            value = (value << 1 ^ 0x8005 if value & 0x8000 else value << 1) & 0xFFFF
    return struct.pack('<H', value)


def answer(terminal):
    while True:
        request = os.read(terminal, 256)
        (address,) = struct.unpack_from('<H', request, 8)
        content = b'\x55\x00' + REGISTERS[address]
        status = b'\xff\xff\xfd\x00\x01' + struct.pack('<H', len(content) + 2) + content
        os.write(terminal, status + checksum(status))


servo, host = pty.openpty()
tty.setraw(servo)
tty.setraw(host)
threading.Thread(target=answer, args=(servo,), daemon=True).start()
port, packets = PortHandler(os.ttyname(host)), PacketHandler(2.0)
assert port.openPort()
position = packets.read4ByteTxRx(port, 1, 132)
current = packets.read2ByteTxRx(port, 1, 126)
group = GroupSyncRead(port, packets, 132, 4)
group.addParam(1)
assert group.txRxPacket() == 0
print('position', position, 'current', current, 'in a group', group.getData(1, 132, 4))
assert position == (4294967295, 0, 0)
assert current == (65531, 0, 0)
assert group.getData(1, 132, 4) == 4294967295
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/servo.py"

#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# myDynamixel 3.1.2: where one of three servos does not answer, multi_read() gives 0 for all three, without an error.
#
# Expected of multi_read('ALL', PresentPosition): the positions of the servos, and None for the one that did not answer,
# as read() gives it, or an exception. What happens: the result of the bulk read is not looked at, and the SDK gives 0
# for what it has not received. It gives up at the first servo that is missing, so that the others are at 0 as well,
# also those that answered before it. A position of 0 is half a turn from the middle of a servo.
# A stub takes the place of the serial line, and answers by protocol 2.0 with the registers of an XM430-W350.
# For us: a lost answer makes a jump of all joints. Read with read(), and publish nothing where it gives None.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    myDynamixel==3.1.2 dynamixel-sdk==4.1.0 pyserial==3.5 numpy==2.3.5
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct

from dynamixel_sdk import PacketHandler
from myDynamixel import myDynamixel

READ, BULK_READ = 0x02, 0x92


class Line:
    """Three servos at 2048, 2500 and 1000 counts."""

    positions = {1: 2048, 2: 2500, 3: 1000}
    lost = None

    def __init__(self, name):
        self.received, self.is_using, self.baudrate = b'', False, 0

    def openPort(self):
        return True

    def setupPort(self, baudrate):
        return True

    def clearPort(self):
        self.received = b''

    def setPacketTimeout(self, length):
        pass

    def isPacketTimeout(self):
        return not self.received

    def writePort(self, packet):
        packet = bytes(packet)
        reads = packet[8:-2]
        if packet[7] == READ:
            reads = packet[4:5] + reads
        assert packet[7] in (READ, BULK_READ)
        for start in range(0, len(reads), 5):
            servo, address, length = struct.unpack_from('<BHH', reads, start)
            if servo in self.positions and servo != self.lost:
                registers = bytearray(200)
                struct.pack_into('<H', registers, 0, 1020)
                struct.pack_into('<i', registers, 132, self.positions[servo])
                data = bytes(registers[address : address + length])
                status = bytes((255, 255, 253, 0, servo, length + 4, 0, 0x55, 0)) + data
                self.received += status + struct.pack('<H', PacketHandler(2.0).updateCRC(0, status, len(status)))
        return len(packet)

    def readPort(self, length):
        read, self.received = self.received[:length], self.received[length:]
        return read


myDynamixel.PortHandler = Line
servos = myDynamixel.Dxlfunc()
assert servos.init('servos') == 3
position = servos.Address.PresentPosition
for Line.lost in (None, 1, 3):
    together = servos.multi_read('ALL', position)
    single = [servos.read(servo, position) for servo in servos.IDs]
    print('no answer from', Line.lost, '- multi_read():', together, '- read():', single)
    expected = [None if servo == Line.lost else Line.positions[servo] for servo in (1, 2, 3)]
    assert single == expected and together == (expected if Line.lost is None else [0, 0, 0])
PYTHON

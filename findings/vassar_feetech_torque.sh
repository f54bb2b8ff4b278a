#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# vassar-feetech-servo-sdk 1.5.0: a joint that held its position and is to turn with 4 % torque gets 49 % for 50 ms.
#
# write_position() and write_torque() of HLS servos take torques from 0 to 1 and change the mode as needed. In both
# modes they are in the register 44, in steps of 6.5 mA: the greatest torque to hold a position, and the torque of the
# torque mode. Expected: the torque is written before the mode, and 0.5 is the same torque in both. What happens: the
# mode is changed first, and the servo turns with the 1000 steps of the former limit until the change has been saved and
# waited for. 0.5 is 500 steps as a limit and 972 as a torque. A speed of -60, in the range of -32767 to 32767 of the
# documentation, is sent as -32708, as its sign is not changed to the bit 15. A port stands in for the servo, with the
# registers that Feetech's own library for the HLS series has.
# For us: write the steps to register 44 with packet_handler.write2ByteTxRx() before write_torque().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check vassar-feetech-servo-sdk==1.5.0 pyserial==3.5
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import time

import scservo_sdk
from vassar_feetech_servo_sdk import ServoController

MODE, ENABLE, TORQUE, SPEED = 33, 40, 44, 46
READ, SYNC_WRITE, EVERYONE = 2, 0x83, 0xFE


class Servo:
    """A port with one HLS servo, which notes each change of its torque in torque mode."""

    def __init__(self, name):
        self.is_using, self.answers, self.turns = False, b'', []
        self.registers = bytearray(256)

    def openPort(self):
        return True

    def setBaudRate(self, rate):
        return True

    def closePort(self):
        pass

    clearPort = closePort

    def setPacketTimeout(self, length):
        pass

    def isPacketTimeout(self):
        return not self.answers

    def number(self, address):
        return int.from_bytes(self.registers[address:address + 2], 'little')

    def write(self, address, data):
        self.registers[address:address + len(data)] = data
        torque = self.number(TORQUE) if self.registers[MODE] == 2 and self.registers[ENABLE] == 1 else None
        if not self.turns or self.turns[-1][1] != torque:
            self.turns.append((time.monotonic(), torque))

    def writePort(self, packet):
        who, instruction, address = packet[2], packet[4], packet[5]
        data = b''
        if instruction == READ:
            data = bytes(self.registers[address:address + packet[6]])
        elif instruction == SYNC_WRITE:
            assert packet[7] == 1
            self.write(address, bytes(packet[8:-1]))
        else:
            self.write(address, bytes(packet[6:-1]))
        if who != EVERYONE:
            answer = bytes([who, len(data) + 2, 0]) + data
            self.answers += b'\xff\xff' + answer + bytes([~sum(answer) & 0xFF])
        return len(packet)

    def readPort(self, length):
        answer, self.answers = self.answers[:length], self.answers[length:]
        return answer


def steps(servo):
    """The torques of the torque mode, and how long the first one of them lasted in s."""
    torques = [(at, torque) for at, torque in servo.turns if torque is not None]
    return [torque for _, torque in torques], torques[-1][0] - torques[0][0]


scservo_sdk.PortHandler = Servo
for prepared in (False, True):
    controller = ServoController([1], 'hls', 'port')
    controller.connect()
    servo = controller.port_handler
    assert controller.write_position({1: 2048}) == {1: True}
    if prepared:
        controller.packet_handler.write2ByteTxRx(1, TORQUE, 77)
    assert controller.write_torque({1: 0.04}) == {1: True}
    torques, duration = steps(servo)
    print(f'torques in steps of 6.5 mA: {torques}, the first one for {1000 * duration:.0f} ms')
    assert torques == ([77] if prepared else [1000, 77]) and (prepared or duration > 0.05)

controller.write_torque({1: 0.5})
as_torque = servo.number(TORQUE)
controller.write_position({1: 2048}, {1: 0.5}, speed=-60)
as_limit, speed = servo.number(TORQUE), servo.number(SPEED)
signed = -(speed & 0x7FFF) if speed & 0x8000 else speed
print(f'0.5 is {as_torque} as a torque and {as_limit} as a limit; a speed of -60 is {signed}')
assert (as_torque, as_limit, signed) == (972, 500, -32708)
PYTHON

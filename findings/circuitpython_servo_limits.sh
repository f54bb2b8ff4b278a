#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# circuitpython-serial-controlled-servo 0.1.3: each move of a servo takes away its angle limits, and a speed of -100 is
# 32868.
#
# A joint's SCS servo has angle limits of 300 and 700 in its registers 9 to 12. Expected of set_position(): the goal
# alone is written. What happens: before each move, 1 and 1023 are written into the limits, since the mode that is kept
# for a servo is looked up under the built-in function id instead of its number: not at the first move alone, as is
# meant, but at every one. A goal of 1000 is then within the limits. speed() and load() give the bit of the sign, bit 15
# of a speed and bit 10 of a load, as part of the number. A servo on a UART answers here.
# For us: check each goal against limits of your own, and take the sign off yourself.
#
# Exit code 0: still so. Installs the version into a temporary folder, where three modules stand in for CircuitPython's
# own.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps circuitpython-serial-controlled-servo==0.1.3
cd "$folder"
# One line, which prints a packet, needs Python 3.12 or CircuitPython.
sed -i "s/self.parameters, \",\")/self.parameters, ',')/" "$folder"/venv/lib/python3*/site-packages/sc_servo.py
mkdir stand_in
echo 'class Pin: pass' > stand_in/microcontroller.py
echo 'const = int' > stand_in/micropython.py
cat > stand_in/busio.py <<'PYTHON'
class UART:
    """A bus with one servo, which keeps its registers and answers each packet."""

    def __init__(self, *_, **__):
        self.registers, self.answer, self.written = bytearray(128), b'', []

    in_waiting = property(lambda self: len(self.answer))

    def reset_input_buffer(self):
        self.answer = b''

    def write(self, packet):
        instruction, address, values = packet[4], packet[5], packet[6:-1]
        data = b''
        if instruction == 2:
            data = bytes(self.registers[address:address + values[0]])
        else:
            self.registers[address:address + len(values)] = values
            self.written.append((address, bytes(values)))
        body = bytes([packet[2], len(data) + 2, 0]) + data
        self.answer = b'\xff\xff' + body + bytes([~sum(body) & 0xff])

    def readinto(self, buffer):
        buffer[:], self.answer = self.answer[:len(buffer)], self.answer[len(buffer):]
PYTHON
PYTHONPATH=stand_in timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from sc_servo import SerialControlledServo


def word(value):
    return value.to_bytes(2, 'big')


bus = SerialControlledServo(None, None)
registers = bus.uart.registers
limits = word(300) + word(700)
registers[9:13] = limits
for goal in (500, 1000):
    registers[9:13] = limits
    bus.set_position(1, goal, 200)
    now = [int.from_bytes(registers[at:at + 2], 'big') for at in (9, 11, 42)]
    print(f'goal {goal}: limits {now[:2]}, goal in the servo {now[2]}, written {bus.uart.written[-2:]}')
    assert now == [1, 1023, goal]
registers[58:60] = word(100 | 1 << 15)
registers[60:62] = word(50 | 1 << 10)
print('speed', bus.speed(1), 'load', bus.load(1))
assert (bus.speed(1), bus.load(1)) == (32868, 1074)
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# dynamixel-control 0.2.4: an XL-330 gets its gains I and D exchanged, and each goal of an XL-320 sets its speed to 0,
# the greatest.
#
# The control table of the XL330 has the gains D, I and P of its position controller at 80, 82 and 84. Expected of
# update_PID(P=400, I=0, D=80): 80 at address 80, and 0 at 82. What happens: D is written to 82 and I to 80. The servo
# gets an integral gain instead of its damping, so that it swings around its goal. The control table of the XL-320 has a
# goal of two bytes at 30, then the speed of two bytes at 32, where 0 is the greatest speed. Expected of a goal of 512:
# two bytes. What happens: four bytes, whose upper two set the speed to 0: a servo that was set to turn slowly goes to
# its first goal at full speed.
# For us: give I as D and D as I for an XL-330; for an XL-320 send the goal with the Dynamixel SDK.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    dynamixel-control==0.2.4 dynamixel-sdk==4.1.0 numpy==2.4.6
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import dynamixel_control.dynamixel as library

BULK_WRITE, HEADER = 0x93, 8


class Port:
    """A port that keeps the memory of each servo on it."""

    def __init__(self, _):
        self.is_using = False
        self.memory = {}

    def openPort(self):
        return True

    def setBaudRate(self, _):
        return True

    def clearPort(self):
        pass

    def writePort(self, packet):
        if packet[HEADER - 1] == BULK_WRITE:
            items = list(packet[HEADER:-2])
            while items:
                servo, address, length = items[0], items[1] + 256 * items[2], items[3] + 256 * items[4]
                self.memory.setdefault(servo, {}).update(enumerate(items[5 : 5 + length], address))
                del items[: 5 + length]
        return len(packet)


library.PortHandler = Port


def word(servos, servo, address):
    memory = servos.portHandler.memory[servo]
    return memory[address] + 256 * memory[address + 1]


servos = library.Dynamixel('port')
servos.add_dynamixel('XL-330', 1, [0, 2048, 4095])
servos.update_PID(P=400, I=0, D=80)
found = {name: word(servos, 1, address) for name, address in {'D': 80, 'I': 82, 'P': 84}.items()}
print('XL-330 has', found)
assert found == {'D': 0, 'I': 80, 'P': 400}

servos = library.Dynamixel('port')
servos.add_dynamixel('XL-320', 1, [0, 511, 1023])
servos.portHandler.memory[1] = {32: 100, 33: 0}
print('XL-320 has a speed of', word(servos, 1, 32))
servos.update_goal(1, 512)
servos.send_goal()
print('XL-320 has a goal of', word(servos, 1, 30), 'and a speed of', word(servos, 1, 32))
assert (word(servos, 1, 30), word(servos, 1, 32)) == (512, 0)
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# tetra-feetech 0.1.0: enabling an STS3215 takes away its limit of acceleration, and a load of -20 % is read as 22.4 %.
#
# The memory table of the STS3215 has a torque switch of one byte at 40, then the acceleration of one byte at 41,
# where 0 is the greatest. Expected of enable(): 1 at address 40. What happens: two bytes are written, so that an
# acceleration of 50 is 0 after it, and the next move begins with a jerk; disable() does so, too. enabled() reads two
# bytes as well: of a servo that is on and has an acceleration of 50 it is False. The load has its sign in bit 10,
# that is 1024. What happens: 1000 is subtracted from it, and there is no sign. A position of -100, as behind a homing
# offset, is read at 50.4 rad instead of -0.15 rad. For us: write the acceleration after enable(), with the SDK below
# it, or use servolab 1.0.0.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check tetra-feetech==0.1.0 feetech-servo-sdk==1.0.0
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
from feetech import Client

ON, ACCELERATION, POSITION, LOAD = 40, 41, 56, 60


class Servo:
    """An STS3215 behind the packet handler of the SDK, with its memory."""

    def __init__(self):
        self.memory = bytearray(80)

    def write1ByteTxRx(self, port, servo, address, value):
        self.memory[address] = value
        return 0, 0

    def write2ByteTxRx(self, port, servo, address, value):
        self.memory[address : address + 2] = value.to_bytes(2, 'little')
        return 0, 0

    def read1ByteTxRx(self, port, servo, address):
        return self.memory[address], 0, 0

    def read2ByteTxRx(self, port, servo, address):
        return int.from_bytes(self.memory[address : address + 2], 'little'), 0, 0


client = Client('port')
client.packet_handler = servo = Servo()
client.connected = True
memory = servo.memory

memory[ACCELERATION] = 50
client.enable(1)
print('enabled:', memory[ON], 'acceleration', memory[ACCELERATION])
assert (memory[ON], memory[ACCELERATION]) == (1, 0)
memory[ACCELERATION] = 50
client.disable(1)
assert (memory[ON], memory[ACCELERATION]) == (0, 0)
memory[ON], memory[ACCELERATION] = 1, 50
print('enabled with an acceleration:', client.enabled(1))
assert not client.enabled(1)
memory[LOAD : LOAD + 2] = (1024 + 200).to_bytes(2, 'little')
memory[POSITION : POSITION + 2] = (0x8000 + 100).to_bytes(2, 'little')
load, position = client.read_load_percent(1), client.read_present_position(1)
print(f'load {load}, position {position:.1f} rad')
assert load == 0.224 and round(position, 1) == 50.4
PYTHON

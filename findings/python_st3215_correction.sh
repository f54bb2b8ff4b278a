#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# python-st3215 1.3.0: a zero corrected by -100 steps is read as -1948, and 10 steps more turn the servo by 162.4°.
#
# The position correction of an ST3215 has 4096 steps a turn and its sign in bit 11, as its maker documents it. Expected
# of read_position_correction() after write_position_correction(-100): -100. What happens: 2148, which has bit 11 and
# 100, is written, as is right, but it is read in two's complement, as -1948. A calibration that reads the correction,
# adds 10 steps and writes the sum moves the zero to -1938 instead of -90 steps, 162.4° away. A positive correction is
# right. A load has its sign in bit 10: -10 % are read as 1124, which is 112.4 % by its documentation. A table of
# registers answers here as a servo does.
# For us: keep the correction that was written, or take what is read below zero as -(correction + 2048).
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check python-st3215==1.3.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from python_st3215 import ST3215


class Port:
    """A servo with the number 1, whose registers can be read and written."""

    is_open = True
    timeout = None

    def __init__(self):
        self.registers = bytearray(128)
        self.answer = b''

    def write(self, packet):
        instruction, address = packet[4], packet[5]
        data = b''
        if instruction == 2:
            data = bytes(self.registers[address:address + packet[6]])
        else:
            self.registers[address:address + len(packet) - 7] = packet[6:-1]
        body = bytes([1, len(data) + 2, 0]) + data
        self.answer = b'\xff\xff' + body + bytes([~sum(body) & 0xFF])

    def read(self, size):
        taken, self.answer = self.answer, b''
        return taken

    def flush(self):
        pass

    def close(self):
        pass


port = Port()
servo = ST3215(ser=port).wrap_servo(1, verify=False)


def correction():
    """Return the correction that the servo has, whose sign is in bit 11."""
    word = int.from_bytes(port.registers[0x1F:0x21], 'little')
    return -(word & 0x7FF) if word & 0x800 else word


read = {}
for steps in (100, -100):
    servo.eeprom.write_position_correction(steps)
    assert correction() == steps
    read[steps] = servo.eeprom.read_position_correction()
servo.eeprom.write_position_correction(read[-100] + 10)
turned = (-90 - correction()) * 360 / 4096
print('corrections of 100 and -100 are read as', list(read.values()))
print(f'10 steps more: {correction()} instead of -90, which is {turned:.1f}° away')
port.registers[0x3C:0x3E] = (0x400 | 100).to_bytes(2, 'little')
load = servo.sram.read_current_load()
print('load of -10 %:', load)
assert (read, correction(), round(turned, 1), load) == ({100: 100, -100: -1948}, -1938, 162.4, 1124)
PYTHON

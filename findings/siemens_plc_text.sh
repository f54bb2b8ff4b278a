#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# siemens-plc 1.13.0: 'J2 out' in a String[10] of an S7 PLC is read as '2 out', and 114 in an array of Char as 141.
#
# A String[n] of an S7 PLC begins with the bytes n, its greatest length, and its actual length. What happens:
# read_str_data removes white space from the bytes before it looks at them, and 9 to 13 and 32 are white space: of a
# String[10] the first byte is lost, so that the first letter is the length and the text begins with the second one.
# The text that write_str_data has written with size 10 is read back so. Numbers in an array of Char whose first one is
# a space, as where they have a fixed width, are shifted by read_char_array: ' 12', ' 13', '114' are 12, 131, 141. A
# PLC with a memory takes the place of the real one.
# For us: declare texts as String[8] or from String[14] to String[31], or read the bytes with snap7 itself.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check siemens-plc==1.13.0 python-snap7==2.1.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from siemens_plc.s7_plc import S7PLC


class Memory:
    """A PLC whose data block keeps what is written."""

    block = bytearray(100)

    def db_read(self, number, start, size):
        return self.block[start:start + size]

    def db_write(self, number, start, data):
        self.block[start:start + len(data)] = data
        return 0


plc = S7PLC('192.0.2.1')
plc._s7_client = memory = Memory()
wrong = {}
for size in range(6, 60):
    plc.write_str_data(1, 0, 'J2 out', size)
    assert memory.block[:8] == bytes([size, 6]) + b'J2 out'
    text = plc.read_str_data(1, 0, size)
    if text != 'J2 out':
        wrong[size] = text.rstrip('\0')
print('J2 out is read as:', wrong)
assert wrong == dict.fromkeys((9, 10, 11, 12, 13, 32), '2 out'), wrong

memory.block[:12] = b' 12' + b' 13' + b'114' + b'115'
angles = plc.read_char_array(1, 0, 3, 4)
print('12, 13, 114 and 115 are read as', angles)
assert angles == ['12 ', '131', '141', '15'], angles
PYTHON

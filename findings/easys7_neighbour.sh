#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# EasyS7 2.0.0: writing the Int of a speed to an S7 PLC sets the Int behind it to 0, and 3000000000 counts are negative.
#
# An Int of an S7 PLC has two bytes. Expected of writeArea(Areas.DB, 0, DataTypes.Int, 500): the bytes 0 and 1 of the
# block. What happens: four bytes are sent, the last two of which are 0, so that a torque limit of 80 at the address 2
# is 0, and the upper half of a 32-bit angle would be as well. A UInt of 500 is sent with two bytes, and a DInt is
# right. Of a layout, a UDInt of 3 000 000 000 is read as -1294967296 and a UInt of 40 000 as -25536, although each of
# them has no sign; readArea() of the same UDInt is right. A PLC with a memory takes the place of the real one.
# For us: write an Int as UInt with data & 0xFFFF; take what is read & 0xFFFFFFFF or & 0xFFFF.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check EasyS7==2.0.0 python-snap7==0.11
cd "$folder"
printf 'count\tUDInt\t0\nlimit\tUInt\t4\nangle\tReal\t6' > layout.txt
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct

from EasyS7.DataBlock import Areas, DataTypes, dbRead, dbReadArea, dbWriteArea
from EasyS7.Utility import getDbSize, getItemsFromDbLayout


class Plc:
    """A PLC whose data block keeps what is written."""

    def __init__(self, block):
        self.block = bytearray(block)

    def db_read(self, number, start, size):
        return self.block[start:start + size]

    def read_area(self, area, number, start, size):
        return self.block[start:start + size]

    def write_area(self, area, number, start, data):
        self.block[start:start + len(data)] = data


found = {}
for kind in ('Int', 'UInt', 'DInt'):
    plc = Plc(struct.pack('>hhh', 100, 80, 7))
    dbWriteArea(plc, Areas.DB, 0, DataTypes[kind], 500, db_num=5)
    found[kind] = struct.unpack('>hhh', plc.block)
    print(f'speed 100, limit 80 and 7: {found[kind]} after 500 was written as', kind)
assert found == {'Int': (500, 0, 7), 'UInt': (500, 80, 7), 'DInt': (0, 500, 7)}, found

items = getItemsFromDbLayout('layout.txt')
plc = Plc(struct.pack('>IHf', 3_000_000_000, 40_000, 1.5))
state = dbRead(plc, 5, getDbSize(items, 'bytebit', 'datatype'), items)
print('3000000000, 40000 and 1.5 are read as', vars(state))
assert (state.count, state.limit, state.angle) == (-1294967296, -25536, 1.5)
assert dbReadArea(plc, Areas.DB, 0, DataTypes.UDInt, db_num=5) == 3_000_000_000
PYTHON

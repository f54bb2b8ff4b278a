#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# s7datablock 0.0.2: an Int of 1000 in an S7 PLC is read as -6141, and an angle of 1.5 rad behind a Byte as 5.9e-39 rad.
#
# The library reads a data block of an S7 PLC by the .db file that TIA Portal exports. By Siemens, a standard data block
# has the high byte of a number first, and each number of 16 or 32 bits at an even address: behind the Byte `mode` at
# 0, the Real `angle` is at 2, the Int `speed` at 6 and the Time `delay` at 8. What happens: `angle` is looked for at 1,
# `speed` at 5 and `delay` at 7, so that 1.5 rad are 5.9e-39 rad. Without the Byte the angle is right, but an Int of
# 1000 is -6141, a Time of 20 ms is 3.9 days and a goal of 1000 is written as -6141, as these two types have their low
# byte first. A UInt, a DInt and a Real are right.
# For us: add a second Byte behind each odd one, declare an Int as UInt or DInt and a Time as DInt.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check s7datablock==0.0.2 python-snap7==3.3.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct
from io import StringIO

from s7datablock import S7DataBlock


def block(declaration):
    """Return a data block that is declared as TIA Portal exports it."""
    return S7DataBlock.from_definition_file(StringIO(f"""DATA_BLOCK "Axis"
{{ S7_Optimized_Access := 'FALSE' }}
VERSION : 0.1
   STRUCT
{declaration}
   END_STRUCT;
BEGIN
END_DATA_BLOCK
"""), db_number=1)


# A Byte, a spare byte, a Real, an Int and a Time, as the PLC sends them.
plc = struct.pack('>BxfhI', 3, 1.5, 1000, 20)
axis = block('      mode : Byte;\n      angle : Real;\n      speed : Int;\n      delay : Time;')
places = {name: field.offset for name, field in axis.mapping.items()}
print('places:', places)
assert places == {'mode': 0, 'angle': 1, 'speed': 5, 'delay': 7}, places
axis.buffer[:] = plc[:axis.db_size]
print('angle of 1.5 rad:', axis['angle'])
assert 0 < axis['angle'] < 1e-38

even = block('      angle : Real;\n      speed : Int;\n      delay : Time;\n      count : DInt;\n      word : UInt;')
assert {name: field.offset for name, field in even.mapping.items()} == {
    'angle': 0, 'speed': 4, 'delay': 6, 'count': 10, 'word': 14}
even.buffer[:] = struct.pack('>fhIiH', 1.5, 1000, 20, -5, 1000)
found = even.to_dict()
print('1.5, 1000, 20 ms, -5 and 1000 are read as', found)
days = found['delay'].total_seconds() / 86400
assert (found['angle'], found['speed'], found['count'], found['word']) == (1.5, -6141, -5, 1000)
assert 3.8 < days < 4, days
even['speed'] = 1000
sent = struct.unpack('>h', even.buffer[4:6])[0]
print('speed 1000 is written as', sent)
assert sent == -6141
PYTHON

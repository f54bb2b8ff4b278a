#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# canopen 2.4.1: a position of 20000 behind a limit switch of one bit in a PDO is read as -12768.
#
# A drive of bitwise granularity maps its limit switch, a BOOLEAN, and then its position, an INTEGER16, into a TPDO: the
# position takes the bits 1 to 16. Expected: each position from -32768 to 32767. What happens: the position is taken
# from the two bytes in which it begins, so that its last bit is lost, and the one before counts as its sign: half of
# all positions, those from 16384 on and those below -16384, are wrong by 32768, without an error. A speed as an
# UNSIGNED16 has only its lower 15 bits. With the position first and the switch behind it all are right.
# For us: map what fills whole bytes first, and single bits behind it.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check canopen==2.4.1 python-can==4.6.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import canopen
from canopen.objectdictionary import ObjectDictionary, ODRecord, ODVariable, datatypes

BYTE, LONG = datatypes.UNSIGNED8, datatypes.UNSIGNED32


def variable(name, index, kind, value=None, subindex=0):
    entry = ODVariable(name, index, subindex)
    entry.data_type, entry.default, entry.pdo_mappable = kind, value, True
    return entry


def record(name, index, *values):
    entries = ODRecord(name, index)
    for subindex, (kind, value) in enumerate(values):
        entries.add_member(variable(f'{name} {subindex}', index, kind, value, subindex))
    return entries


def read(order, values, kind=datatypes.INTEGER16):
    """What a master reads of these positions, or speeds, with the limit switch on."""
    dictionary = ObjectDictionary()
    dictionary.add_object(variable('Switch', 0x2000, datatypes.BOOLEAN))
    dictionary.add_object(variable('Value', 0x2001, kind))
    sizes = {'Switch': 0x20000001, 'Value': 0x20010010}
    mapped = [(LONG, sizes[name]) for name in order]
    dictionary.add_object(record('TPDO', 0x1800, (BYTE, 2), (LONG, 0x181), (BYTE, 255)))
    dictionary.add_object(record('Mapping', 0x1A00, (BYTE, 2), *mapped))
    node = canopen.RemoteNode(1, dictionary)
    node.network = node.tpdo.network = node.sdo.network = canopen.Network()
    node.tpdo.read(from_od=True)
    received = node.tpdo[1]
    found = []
    for value in values:
        bits = 1 | (value & 0xFFFF) << 1 if order[0] == 'Switch' else value & 0xFFFF | 1 << 16
        received.data = bytearray(bits.to_bytes(3, 'little'))
        assert received['Switch'].raw
        found.append(received['Value'].raw)
    return found


values = list(range(-32768, 32768))
behind, before = read(['Switch', 'Value'], values), read(['Value', 'Switch'], values)
speeds = read(['Switch', 'Value'], [100, 40000], datatypes.UNSIGNED16)
wrong = [value for value, found in zip(values, behind) if value != found]
print('20000 is read as', behind[20000 + 32768], 'wrong are', len(wrong), 'positions; speeds of 100 and 40000:', speeds)
assert before == values
assert behind[20000 + 32768] == -12768 and behind[100 + 32768] == 100
assert wrong == [value for value in values if not -16384 <= value < 16384]
assert all(abs(value - behind[value + 32768]) == 32768 for value in wrong)
assert speeds == [100, 40000 - 32768]
PYTHON

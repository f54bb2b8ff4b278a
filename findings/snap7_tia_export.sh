#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# python-snap7 3.3.0: by a TIA Portal export, each variable of a data block is at byte 0, and of two axes one is left.
#
# load_tia_xml() makes tags of the XML that TIA Portal exports of a data block. There a variable has its place, in
# bits, as an IntegerAttribute named Offset if read-only attributes are exported, and a structure has its members
# inside. Expected: the speed of the second axis at byte 20, or an error. What happens: an attribute Offset of the
# variable itself is looked for, which such a file does not have, and 0 is taken in its place: the first position,
# 12.5 rad, is read as the speed, and a goal overwrites that position. The members of both axes have the same names,
# without their axis, so that the second axis replaces the first. Nothing warns. The server of the package answers here.
# For us: write the tags into a .csv for load_csv(), with their bytes, and check one value that is known.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check python-snap7==3.3.0
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import ctypes
import socket
from pathlib import Path

import snap7
from snap7.server import Server
from snap7.type import SrvArea


def member(name, kind, bits, inside=''):
    return (
        f'<Member Name="{name}" Datatype="{kind}" Remanence="NonRetain" Accessibility="Public"><AttributeList>'
        f'<IntegerAttribute Name="Offset" Informative="true" SystemDefined="true">{bits}</IntegerAttribute>'
        f'</AttributeList>{inside}</Member>'
    )


def axis(name, byte):
    members = (('position', 'Real', 0), ('goal', 'Real', 4), ('speed', 'Real', 8))
    return member(name, 'Struct', 8 * byte, ''.join(member(n, kind, 8 * at) for n, kind, at in members))


body = axis('first', 0) + axis('second', 12)
Path('axes.xml').write_text(
    '<?xml version="1.0" encoding="utf-8"?>\n<Document><Engineering version="V18" /><SW.Blocks.GlobalDB ID="0">'
    '<AttributeList><Interface><Sections xmlns="http://www.siemens.com/automation/Openness/SW/Interface/v5">'
    f'<Section Name="Static">{body}</Section></Sections></Interface><MemoryLayout>Standard</MemoryLayout>'
    '<Name>axes</Name><Number>7</Number></AttributeList></SW.Blocks.GlobalDB></Document>\n'
)
tags = snap7.load_tia_xml(Path('axes.xml'))
print({name: (f'DB{tag.db_number}', tag.byte_offset, tag.datatype) for name, tag in tags.items()})
assert {tag.byte_offset for tag in tags.values()} == {0} and tags['speed'].db_number == 7
assert list(tags) == ['first', 'position', 'goal', 'speed', 'second']

with socket.create_server(('127.0.0.1', 0)) as free:
    port = free.getsockname()[1]
memory = (ctypes.c_uint8 * 32)()
server = Server()
server.register_area(SrvArea.DB, 7, memory)
server.start(tcp_port=port)
client = snap7.Client()
client.connect('127.0.0.1', 0, 1, port)
client.write_tag('DB7.DBD0:REAL', 12.5)
speed = client.read_tag(tags['speed'])
client.write_tag(tags['goal'], 3.0)
position, goal = client.read_tag('DB7.DBD0:REAL'), client.read_tag('DB7.DBD16:REAL')
client.disconnect()
server.stop()
print('speed', speed, '; after a goal of 3.0: first position', position, ', goal of the second axis', goal)
assert (speed, position, goal) == (12.5, 3.0, 0.0)
PYTHON

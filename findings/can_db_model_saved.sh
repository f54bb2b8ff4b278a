#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# can-db-model 0.1.0: by a .kcd that it has loaded and saved, a position of 1.5 rad is -4.598 rad and has no limits.
#
# A .kcd of a drive has a position and a torque with the high byte first. Expected of load_kcd() and dump_kcd(): a file
# by which cantools decodes a frame as by the first one. What happens: such a signal at the offset 0 is saved at 7, and
# one at 16 at 23, since the start bits of cantools, which are those of a .dbc, are written as offsets: 1.5 rad and 10
# N·m are -4.598 rad and 0 N·m. Signals with the low byte first are right. The min and max of a signal are lost, and so
# is the extended identifier of a message if its number is no larger than 0x7FF, so that it is taken as another
# message. None of this is said by an error.
# For us: save by cantools, database.as_kcd_string().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check can-db-model==0.1.0 cantools==45.1.0
cd "$folder"
cat > drive.kcd <<'XML'
<NetworkDefinition xmlns="http://kayak.2codeornot2code.org/1.0">
  <Document name="drive"/>
  <Bus name="joints" baudrate="1000000">
    <Message id="0x108" length="8" name="State" format="extended">
      <Signal name="position" offset="0" length="16" endianess="big">
        <Value type="signed" slope="0.001" unit="rad" min="-3" max="3"/>
      </Signal>
      <Signal name="torque" offset="16" length="8" endianess="big"><Value type="signed" slope="0.5"/></Signal>
      <Signal name="speed" offset="40" length="16" endianess="little"><Value type="signed" slope="0.01"/></Signal>
    </Message>
  </Bus>
</NetworkDefinition>
XML
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct

import cantools
from can_db_model import dump_kcd, load_kcd

dump_kcd(load_kcd('drive.kcd'), 'saved.kcd')
frame = struct.pack('>hb', 1500, 20) + struct.pack('<2xhx', -200)
found = []
for name in ('drive.kcd', 'saved.kcd'):
    message = cantools.database.load_file(name).messages[0]
    position = message.get_signal_by_name('position')
    found.append((message.decode(frame), (position.minimum, position.maximum), message.is_extended_frame))
    print(name, *found[-1])
assert found == [
    ({'position': 1.5, 'torque': 10.0, 'speed': -2.0}, (-3, 3), True),
    ({'position': -4.598, 'torque': 0.0, 'speed': -2.0}, (None, None), False),
], found
PYTHON

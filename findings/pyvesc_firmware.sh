#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pyvesc 1.0.5: the answer of a VESC since firmware 3 is read without an error: 49000 rpm are -1083702824 rpm.
#
# Expected: values, or an error about the length of 64 bytes instead of 56. What happens: GetValues has the layout of
# the firmware before 3, with seven temperatures at its head; the checksum is right, and what follows the two
# temperatures of today is read at other places: a motor current of 27.5 A and 47.2 V as 0.0, a tachometer of 15000 as
# 983040000. The package needs PyCRC without saying so, here from pythoncrc.
# For us: no speed of a rotor from this release; take the layout from the firmware of the drive.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check setuptools==80.9.0 wheel==0.45.1 pyvesc==1.0.5 pythoncrc==1.21
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct
import warnings

warnings.simplefilter('ignore')

import pyvesc  # noqa: E402
from PyCRC.CRCCCITT import CRCCCITT  # noqa: E402

fields = (
    ('temp_mos', 'h', 312), ('temp_motor', 'h', 405), ('current_motor', 'i', 2750), ('current_in', 'i', 1250),
    ('id', 'i', 0), ('iq', 'i', 2700), ('duty', 'h', 420), ('rpm', 'i', 49000), ('v_in', 'h', 472),
    ('amp_hours', 'i', 10000), ('amp_hours_charged', 'i', 0), ('watt_hours', 'i', 20000),
    ('watt_hours_charged', 'i', 0), ('tachometer', 'i', 15000), ('tachometer_abs', 'i', 16000),
    ('fault', 'b', 0), ('position', 'i', 123000000), ('controller', 'B', 7),
)
answer = bytes([4]) + b''.join(struct.pack(f'>{layout}', value) for _, layout, value in fields)
packet = bytes([2, len(answer)]) + answer + struct.pack('>HB', CRCCCITT().calculate(answer), 3)
message, consumed = pyvesc.decode(packet)
print({name: getattr(message, name) for name in message._field_names})
assert consumed == len(packet)
assert message.rpm == -1083702824 and message.current_motor == 0.0 and message.v_in == 0.0
PYTHON

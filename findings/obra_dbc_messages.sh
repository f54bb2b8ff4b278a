#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# obra-tools 0.1.0: the ROS message that it makes of a .dbc cannot hold a speed of -10 rad/s or a torque of 600 N·m,
# which the .dbc can.
#
# obra-dbc-to-msg makes a .msg of each frame. Expected: fields that hold all values of the signals. What happens: the
# type is that of the raw bits, unless the factor is less than 1; the offset is ignored. A speed of an unsigned byte
# with an offset of -128, from -128 to 127 rad/s, gets a uint8, a torque of a byte in steps of 10 N·m up to 2550 N·m a
# uint8, and a speed in steps of 2.5 rad/s a uint8 too. A position of 32 bits in steps of 1e-6 rad gets a float32, whose
# steps are 122 times as large at 1024 rad. The fields are meant for decoded values: a factor of 0.1 gives a float, and
# their ranges are in the comments, such as "(rad/s) [-128 - 127]" above a uint8.
# For us: make all fields float64 that have a factor or an offset.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check obra-tools==0.1.0 cantools==45.1.0 numpy==2.4.6
cd "$folder"
cat > motor.dbc <<'DBC'
VERSION ""
NS_ :
BS_:
BU_: Drive
BO_ 100 Motor: 8 Drive
 SG_ speed : 0|8@1+ (1,-128) [-128|127] "rad/s" Drive
 SG_ torque : 8|8@1+ (10,0) [0|2550] "Nm" Drive
 SG_ rate : 16|8@1+ (2.5,0) [0|637.5] "rad/s" Drive
 SG_ current : 24|8@1- (0.1,0) [-12.8|12.7] "A" Drive
 SG_ position : 32|32@1- (1E-006,0) [-2147.483648|2147.483647] "rad" Drive
DBC
PATH="$folder/venv/bin:$PATH"
obra-dbc-to-msg motor.dbc messages
cat messages/Motor.msg
timeout 60 python - <<'PYTHON'
from pathlib import Path

import cantools
import numpy as np

lines = Path('messages/Motor.msg').read_text().splitlines()
types = {name: kind for kind, name in (line.split() for line in lines if line and line[0] != '#')}
expected = {'speed': 'uint8', 'torque': 'uint8', 'rate': 'uint8', 'current': 'float32', 'position': 'float32'}
assert types == expected, types
(frame,) = cantools.database.load_file('motor.dbc').messages
values = {'speed': -10, 'torque': 600, 'rate': 2.5, 'current': -1.5, 'position': 1024.001}
decoded = frame.decode(frame.encode(values))
print('decoded:', decoded)
assert all(abs(decoded[name] - value) < 1e-6 for name, value in values.items())
for name in ('speed', 'torque', 'rate'):
    ends = np.iinfo(types[name])
    assert not (ends.min <= decoded[name] <= ends.max and float(decoded[name]).is_integer()), name
assert round(float(np.spacing(np.float32(1024))) / 1e-6) == 122
PYTHON

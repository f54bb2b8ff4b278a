#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# candied 2.2.0: a speed of -0.06 rad/s in Motorola order is read as -25.61, and a float of -1.5 rad as -1077936128 rad.
#
# A .dbc describes five signals: a position in Intel order, a speed in Motorola order, a float, and two signals that
# share their bytes, an angle on page 0 and a load on page 1. What happens: signals of 16 bits in Motorola order are put
# together from wrong bits; a float is read as a whole number, although its type is known to be float; both pages are
# read from each frame; and a position beyond its range [-12.5|12.5] is read as the limit. All without an error;
# cantools 45.1.0 reads all right.
# For us: candied reads whole numbers in Intel order on one page; read others with another library.
#
# Exit code 0: still so. Needs node; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts candied@2.2.0
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check cantools==45.1.0
cat > drive.dbc <<'DBC'
VERSION ""
NS_ :
BS_:
BU_: HOST
BO_ 100 Drive: 4 HOST
 SG_ Position : 0|16@1- (0.001,0) [-12.5|12.5] "rad" HOST
 SG_ Speed : 23|16@0- (0.01,0) [0|0] "rad/s" HOST

BO_ 101 Motor: 4 HOST
 SG_ Precise : 0|32@1- (1,0) [0|0] "rad" HOST

BO_ 102 Pages: 5 HOST
 SG_ Page M : 0|8@1+ (1,0) [0|0] "" HOST
 SG_ Angle m0 : 8|32@1- (0.0001,0) [0|0] "rad" HOST
 SG_ Load m1 : 8|16@1- (0.1,0) [0|0] "Nm" HOST

SIG_VALTYPE_ 101 Precise : 1;
DBC
cat > read.mjs <<'JAVASCRIPT'
import fs from 'node:fs';
import candied from 'candied';
const can = new candied.Can();
can.database = new candied.Dbc().load(fs.readFileSync('drive.dbc', 'utf8'));
const read = JSON.parse(process.argv[2]).map(([id, data]) => {
  const message = can.decode(can.createFrame(id, data));
  return Object.fromEntries([...message.boundSignals].map(([name, signal]) => [name, Math.round(signal.value * 1e4) / 1e4]));
});
console.log(JSON.stringify(read));
JAVASCRIPT
timeout 60 venv/bin/python - <<'PYTHON'
import json
import struct
import subprocess

import cantools

frames = [
    (100, struct.pack('<h', -6) + struct.pack('>h', -6)),
    (100, struct.pack('<h', 25000) + struct.pack('>h', 1)),
    (101, struct.pack('<f', -1.5)),
    (102, struct.pack('<Bi', 0, -31416)),
]
known = cantools.database.load_file('drive.dbc')
right = [known.decode_message(*frame) for frame in frames]
command = ['node', 'read.mjs', json.dumps([(one, list(data)) for one, data in frames])]
read = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
print('cantools', right, 'candied', read, sep='\n')
assert right == [
    {'Position': -0.006, 'Speed': -0.06},
    {'Position': 25.0, 'Speed': 0.01},
    {'Precise': -1.5},
    {'Page': 0, 'Angle': -3.1416},
]
assert read[0] == {'Position': -0.006, 'Speed': -25.61}
assert read[1]['Position'] == 12.5
assert read[2] == {'Precise': -1077936128}
assert read[3] == {'Page': 0, 'Angle': -3.1416, 'Load': -3141.6}
PYTHON

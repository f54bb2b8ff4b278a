#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# candied 2.2.0 (npm): by a .dbc, a torque of 10 N·m whose byte order is that of Motorola is read as -36 N·m.
#
# A drive sends its position, torque and speed with the high byte first, which a .dbc writes as `7|16@0-`: the start
# bit is the highest bit of the signal. Expected, as cantools decodes it: 1.5 rad, 10 N·m and -2 rad/s. What happens:
# the start bit is taken as the lowest one, so that -36 N·m and -183.91 rad/s are read, without an error, and NaN where
# the signal would begin before the frame. Signals of Intel's byte order are right. A float, by SIG_VALTYPE_, is read
# as a whole number: 1.5 rad are 1069547520 rad. The names of VAL_ belong to raw values, but are looked up by scaled
# ones: the mode 2 with a factor of 0.5 is "Calibration" instead of "Run".
# For us: decode by cantools; with candied, only whole numbers in Intel's byte order.
#
# Exit code 0: still so. Needs node; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund --ignore-scripts candied@2.2.0
cat > decode.cjs <<'JS'
const assert = require('node:assert');
const { Can, Dbc } = require('candied');

const can = new Can();
can.database = new Dbc().load(`VERSION ""

NS_ :

BS_:

BU_: Drive

BO_ 264 State: 8 Drive
 SG_ Position : 7|16@0- (0.001,0) [0|0] "rad" Vector__XXX
 SG_ Torque : 23|8@0- (0.5,0) [0|0] "Nm" Vector__XXX
 SG_ Speed : 31|16@0- (0.01,0) [0|0] "rad/s" Vector__XXX
 SG_ Mode : 40|4@1+ (0.5,0) [0|0] "" Vector__XXX

BO_ 265 Angle: 8 Drive
 SG_ Angle : 0|32@1- (1,0) [0|0] "rad" Vector__XXX
 SG_ Count : 32|16@1- (1,0) [0|0] "" Vector__XXX

VAL_ 264 Mode 1 "Calibration" 2 "Run" ;
SIG_VALTYPE_ 265 Angle : 1;
`);

function decoded(id, bytes) {
  const values = {};
  for (const [name, signal] of can.decode(can.createFrame(id, [...bytes])).boundSignals) {
    values[name] = name === 'Mode' ? signal.physValue : signal.value;
  }
  return values;
}

const state = Buffer.alloc(8);
state.writeInt16BE(1500, 0);
state.writeInt8(20, 2);
state.writeInt16BE(-200, 3);
state.writeUInt8(2, 5);
const angle = Buffer.alloc(8);
angle.writeFloatLE(1.5, 0);
angle.writeInt16LE(-5, 4);
const found = { ...decoded(264, state), ...decoded(265, angle) };
console.log('1.5 rad, 10 Nm, -2 rad/s, Run, 1.5 rad and -5:', found);
assert.deepStrictEqual(found, {
  Position: NaN, Torque: -36, Speed: -183.91, Mode: 'Calibration', Angle: 1069547520, Count: -5,
});
JS
timeout 60 node decode.cjs

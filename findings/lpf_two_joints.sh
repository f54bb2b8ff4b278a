#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# lpf 1.0.0 (npm): two joints share one filter, angles below 0.5 rad in an array become 0, and each value is filtered ten times.
#
# The module is itself a filter. Expected of a low-pass of y += 0.1 (x - y): after 7 readings at 100 rad it is at half of them. What
# happens: next() filters its last ten values, which it has filtered already, once more, so that 40 readings are needed.
# Expected of a joint at 100 rad and one at 0: 100 and 0. What happens: whatever requires the module gets the same filter, so that two
# joints whose readings alternate are read at 71.4 and 28.6 rad. Expected of smoothArray([0, 0.1, 0.2, 0.3, 0.4, 0.45]) with 0.5: 0 to
# 0.38. What happens: each value is rounded to a whole number, in the array that was given: all are 0.
# For us: write the line y += 0.1 * (x - y) for each joint.
#
# Exit code 0: still so. Needs node; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts lpf@1.0.0
cat > joints.mjs <<'JAVASCRIPT'
import assert from 'node:assert';
import { createRequire } from 'node:module';

const require = createRequire(import.meta.url);
const [first, second] = [require('lpf'), require('lpf')];

/** How many readings of 100 rad it takes from 0 to half of them. */
function readingsToHalf(next) {
  let readings = 1;
  while (next(100) < 50) {
    readings++;
  }
  return readings;
}

let filtered = 0;
const expected = readingsToHalf((reading) => { filtered += 0.1 * (reading - filtered); return filtered; });
first.smoothing = 0.1;
first.init([]);
const found = readingsToHalf((reading) => first.next(reading));
console.log('readings to half:', found, 'instead of', expected);
assert.deepEqual([found, expected], [40, 7]);

first.smoothing = 0.5;
let joints;
for (let reading = 0; reading < 100; reading++) {
  joints = [first.next(100), second.next(0)];
}
console.log('joints at 100 and 0 rad are read at', joints);
assert.ok(Math.abs(joints[0] - 71.44) < 0.01 && Math.abs(joints[1] - 28.56) < 0.01);

const angles = [0, 0.1, 0.2, 0.3, 0.4, 0.45];
first.smoothArray(angles);
console.log('angles:', angles);
assert.deepEqual(angles, [0, 0, 0, 0, 0, 0]);
JAVASCRIPT
timeout 60 node joints.mjs

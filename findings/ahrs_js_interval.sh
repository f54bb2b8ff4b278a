#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# ahrs 1.3.3 (npm): at 100 Hz, a turn of an arm by 5.7° is found as 57°, and an arm that lies exactly level is at NaN.
#
# The README gives sampleInterval in Hz, but the filters take it as milliseconds: 100 is then 10 Hz, and rates turn the
# orientation ten times too far; with 20, 20 ms. A time given to update() is right, and is kept for the later updates
# without one. Where the measured gravity is exactly along z, as in a simulation, Madgwick divides a correction of 0 by
# its length of 0, and all angles stay NaN from then on; Mahony does not. The Python package of this name is another
# one.
# For us: give update() the time between two samples.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts ahrs@1.3.3
grep -q 'sample interval, in Hz' node_modules/ahrs/README.md
cat > turn.cjs <<'JAVASCRIPT'
const assert = require('node:assert');
const AHRS = require('ahrs');

const tilt = 0.001; // m/s², as an exactly level one is NaN in Madgwick
function heading(algorithm, seconds) {
  const filter = new AHRS({ algorithm, sampleInterval: 100 });
  for (let sample = 0; sample < 10; sample++) {
    filter.update(0, 0, 1, tilt, 0, 9.81, undefined, undefined, undefined, seconds);
  }
  return (filter.getEulerAngles().heading * 180) / Math.PI;
}
function level(algorithm) {
  const filter = new AHRS({ algorithm, sampleInterval: 100 });
  filter.update(0, 0, 0, 0, 0, 9.81);
  filter.update(0, 0, 0, tilt, 0, 9.81);
  return filter.getEulerAngles().heading;
}
for (const algorithm of ['Madgwick', 'Mahony']) {
  const angles = [heading(algorithm), heading(algorithm, 0.01)];
  console.log(algorithm, 'heading after 0.1 s at 1 rad/s', angles, 'level', level(algorithm));
  assert.ok(Math.abs(angles[0] - 57.3) < 0.5);
  assert.ok(Math.abs(angles[1] - 5.73) < 0.05);
}
assert.ok(Number.isNaN(level('Madgwick')));
assert.ok(Math.abs(level('Mahony')) < 1e-6);
JAVASCRIPT
timeout 60 node turn.cjs

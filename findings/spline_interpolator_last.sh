#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# spline-interpolator 1.0.0 (npm): the last point of a smoothed path is the reading, 0.24 rad beside the path.
#
# Readings of 0 and 1 rad in turns, one a second, are smoothed with a lambda of 0.5. Expected at the last one: 0.757
# rad, as the path is 1 ns before and after, and as that of SciPy with the same weights is. What happens: 1 rad, the
# reading itself. The first point and all between are smoothed, and with a lambda of 1, the default, all are the
# readings.
# For us: ask for a time slightly before the last one.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts spline-interpolator@1.0.0
cat > last.cjs <<'JAVASCRIPT'
const assert = require('node:assert');
const Spline = require('spline-interpolator');

const [times, readings] = [[0, 1, 2, 3, 4, 5], [0, 1, 0, 1, 0, 1]];
const around = (spline, time) => [-1e-9, 0, 1e-9].map((change) => spline.interpolate(time + change));
const exact = new Spline(times, readings);
times.forEach((time, place) => assert.ok(Math.abs(exact.interpolate(time) - readings[place]) < 1e-9));

const smoothed = new Spline(times, readings, 0.5);
for (const time of times.slice(0, -1)) {
  const found = around(smoothed, time);
  assert.ok(Math.max(...found) - Math.min(...found) < 1e-7);
}
// The readings are symmetric about the middle of the record, thus the path is as well.
const expected = 1 - smoothed.interpolate(0);
const last = around(smoothed, 5);
console.log('last point:', last[1], 'rad, around it:', last[0], last[2], 'rad, expected', expected, 'rad');
assert.strictEqual(last[1], 1);
[last[0], last[2]].forEach((found) => assert.ok(Math.abs(found - expected) < 1e-7));
assert.ok(Math.abs(expected - 0.757) < 0.001);
JAVASCRIPT
timeout 60 node last.cjs

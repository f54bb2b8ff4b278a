#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# cubic-hermite-spline 1.0.1 (npm): the end of a path without knots is NaN, and speeds are off by the time of a part.
#
# A joint moves from 0 to 2 rad at a constant speed of 1 rad/s, with the knots 0 s and 2 s. Expected as its
# derivative: 1 rad/s, as the difference of two positions has it. What happens: 2 rad/s, as it is not divided by the
# time of the part. Without knots, a path of three points has its time from 0 to 1, and the derivative is 1 where the
# positions have 2. At 1, the end of the path, its position and its derivative are NaN, as the last point is taken as
# a part without length; with knots, the end is right.
# For us: give knots, and divide the derivative by the distance between the two knots around it.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts cubic-hermite-spline@1.0.1
cat > end.cjs <<'JAVASCRIPT'
const assert = require('node:assert');
const spline = require('cubic-hermite-spline');

// The tangents are speeds in time of the knots; without knots, one part lasts for 1.
const step = 1e-6;
function speeds(time, points, tangents, knots) {
  const [before, after] = [-step, step].map((change) => spline(time + change, points, tangents, knots)[0]);
  return [spline(time, points, tangents, knots, true)[0], (after - before) / (2 * step)];
}

for (const [time, points, tangents, knots, expected] of [
  [1, [[0], [1]], [[1], [1]], [0.5, 1.5], [1, 1]],
  [1, [[0], [2]], [[1], [1]], [0, 2], [2, 1]],
  [0.25, [[0], [1], [2]], [[1], [1], [1]], undefined, [1, 2]],
]) {
  const found = speeds(time, points, tangents, knots);
  console.log('knots', knots, 'derivative', found[0], 'rad/s, by positions', found[1].toFixed(6), 'rad/s');
  found.forEach((speed, place) => assert.ok(Math.abs(speed - expected[place]) < 1e-6));
}

const [points, tangents] = [[[0], [1], [2]], [[1], [1], [1]]];
const end = (time, knots) => spline(time, points, tangents, knots)[0];
const ends = [end(1), end(1 - step), end(2, [0, 1, 2])];
console.log('end', ends[0], 'just before', ends[1], 'with knots', ends[2]);
assert.ok(Number.isNaN(ends[0]) && Number.isNaN(spline(1, points, tangents, undefined, true)[0]));
assert.ok(Math.abs(ends[1] - 2) < 1e-5 && ends[2] === 2);
JAVASCRIPT
timeout 60 node end.cjs

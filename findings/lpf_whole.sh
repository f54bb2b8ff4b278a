#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# lpf 1.0.0 (npm): a smoothed array of angles has whole radians, and a stream of them lags four times as much.
#
# A joint moves from 0 to 0.45 rad, in one step, and its readings are smoothed with 0.2. Expected after ten readings:
# 0.402 rad, the step times 1 - 0.8 to the power of 10, whether they come in an array or as a stream. What happens: in
# the array, which is changed in place, each reading but the first is rounded, thus 0. As a stream, it is at 0.201 rad,
# since each of the last ten outputs is smoothed once more with each reading, as in the example of its README; 63 % of
# the step takes 19 readings, and not 5. The module is a single filter, thus a second joint gets what the first one had.
# For us: calculate value += (reading - value) * smoothing, one value a joint.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts lpf@1.0.0
cat > whole.cjs <<'JAVASCRIPT'
const assert = require('node:assert');
const filter = require('lpf');

filter.smoothing = 0.2;
const step = 0.45;
const expected = (readings) => step * (1 - 0.8 ** readings);

const array = filter.smoothArray([0, ...new Array(10).fill(step)]);
filter.init(new Array(10).fill(0));
const stream = Array.from({ length: 30 }, () => filter.next(step));
const rise = (values) => values.findIndex((value) => value > step * (1 - Math.exp(-1))) + 1;
const rises = [rise(stream), rise(Array.from({ length: 30 }, (_, place) => expected(place + 1)))];
console.log('after ten readings:', array[10], 'rad in an array,', stream[9].toFixed(3), 'rad as a stream, expected',
  expected(10).toFixed(3), 'rad; 63 % after', rises[0], 'readings, expected', rises[1]);
assert.ok(array.every((value) => value === 0));
assert.ok(Math.abs(expected(10) - 0.402) < 0.001 && Math.abs(stream[9] - 0.2007) < 0.001);
assert.ok(Math.abs(stream[0] - expected(1)) < 1e-12);
assert.deepStrictEqual(rises, [19, 5]);

const other = require('lpf');
filter.init(new Array(10).fill(0));
filter.next(10);
const disturbed = other.next(0);
console.log('a second joint at 0 rad:', disturbed, 'rad');
assert.ok(other === filter && disturbed > 0.3);
JAVASCRIPT
timeout 60 node whole.cjs

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# lowpassf 0.5.0 (npm): after its window is set while it runs, four outputs are NaN, and a filled window is not used.
#
# A joint stands at 1 rad, and 30 of its readings went through a window of 20. Then the window is set to 5, for less
# lag. Expected: 1 rad at each further reading. What happens: the window is empty, but the count of the readings goes
# on, so that it is taken as full: NaN four times. The other way, a window is filled with 1 rad, where the joint starts,
# and the first reading is an outlier of 2 rad. Expected of a simple average over 20: 1.05 rad. What happens: 2 rad, as
# only what was counted as a reading is used.
# For us: make another filter for another window, and put the first value in as often as the window is long.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts lowpassf@0.5.0
cat > range.cjs <<'JAVASCRIPT'
const assert = require('node:assert');
const LowpassFilter = require('lowpassf');

function put(filter, reading) {
  filter.putValue(reading);
  return filter.getFilteredValue();
}

for (const logic of ['SimpleAverage', 'LinearWeightAverage']) {
  const filter = new LowpassFilter();
  filter.setLogic(filter[logic]);
  for (let reading = 0; reading < 30; reading++) assert.ok(Math.abs(put(filter, 1) - 1) < 1e-12);
  filter.setSamplingRange(5);
  const found = Array.from({ length: 6 }, () => put(filter, 1));
  console.log(logic, 'after another window:', found);
  assert.deepStrictEqual(found, [NaN, NaN, NaN, NaN, 1, 1]);
}

const filled = new LowpassFilter();
filled.setLogic(filled.SimpleAverage);
filled.fillValue(1);
const first = put(filled, 2);
console.log('filled with 1 rad, first reading 2 rad:', first, 'rad, expected 1.05 rad');
assert.ok(filled.getSampingBuffer().slice(1).every((value) => value === 1));
assert.strictEqual(first, 2);
JAVASCRIPT
timeout 60 node range.cjs

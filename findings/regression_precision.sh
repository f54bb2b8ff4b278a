#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# regression 2.0.1 (npm): a gear of 19 with an offset of 0.01 rad is found as 0.05 and 1.33 rad, with an R² of 1.
#
# An output follows its rotor from 0 to 1000 rad without any error. Expected of linear(): 0.0526 and 0.01, of two
# significant figures at least, as its README calls the option `precision`, whose default is 2. What happens: the ratio
# is rounded to two decimals, the offset is computed from the ratio so rounded, and predict() uses both: it is 1.32 rad
# off at both ends, while R², rounded as well, is 1. For a rotor in counts of 1/1000 rad the ratio is 0. A torque that
# decays by 0.4 % a second, by exponential(), is constant. With { precision: 10 } all are right; simple-statistics
# 7.12.1 does not round.
# For us: give each fit a precision of 10 or more, or fit by simple-statistics.
#
# Exit code 0: still so. Needs node; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund --ignore-scripts regression@2.0.1 simple-statistics@7.12.1
cat > fit.cjs <<'JS'
const assert = require('node:assert');
const regression = require('regression');
const { linearRegression } = require('simple-statistics');

const pairs = Array.from({ length: 1001 }, (_, rotor) => [rotor, rotor / 19 + 0.01]);
const counts = pairs.map(([rotor, output]) => [1000 * rotor, output]);
const decay = Array.from({ length: 50 }, (_, time) => [time / 10, 0.5 * Math.exp((-0.004 * time) / 10)]);
const fit = regression.linear(pairs);
const ends = [0, 1000].map((rotor) => +(fit.predict(rotor)[1] - rotor / 19 - 0.01).toFixed(2));
const found = {
  rounded: fit.equation, r2: fit.r2, ends,
  counts: regression.linear(counts).equation[0],
  decay: regression.exponential(decay).equation,
};
const precise = regression.linear(pairs, { precision: 10 });
const other = linearRegression(pairs);
console.log(found, 'with a precision of 10:', precise.equation, 'by simple-statistics:', other);
assert.deepEqual(found, { rounded: [0.05, 1.33], r2: 1, ends: [1.32, -1.31], counts: 0, decay: [0.5, -0] });
for (const [ratio, offset] of [precise.equation, [other.m, other.b]]) {
  assert.ok(Math.abs(ratio - 1 / 19) < 1e-9 && Math.abs(offset - 0.01) < 1e-6);
}
JS
timeout 60 node fit.cjs

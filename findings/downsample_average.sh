#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# downsample 1.4.0 (npm): after one NaN its moving average is NaN for good, and after one error word it is 0 of 1.
#
# A shaft that stands at 1 rad, 200 samples, of which one is NaN, as an encoder marks a fault. Expected of SMA() with
# a window of 10: ten averages without a value. What happens: all 150 from the fault on are NaN, since each average is
# the last one plus the new sample less the old one. Where the fault is a word of 64 bits that are all set, read as
# 1.8e19, the averages are 0 rad for the rest of the record. ASAP() smooths with the same sum; LTTB() stops at a NaN
# with a TypeError, and LTOB() leaves it out.
# For us: take invalid samples out before SMA() or ASAP().
#
# Exit code 0: still so. Needs node; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts downsample@1.4.0
cat > average.cjs <<'JAVASCRIPT'
const assert = require('node:assert');
const { SMA } = require('downsample');

const record = (fault) => Array.from({ length: 200 }, (_, time) => ({ x: time, y: time === 50 ? fault : 1 }));
const averages = (fault) => SMA(record(fault), 10).map(({ y }) => y);
const [sound, invalid, huge] = [1, NaN, Number(2n ** 64n - 1n)].map(averages);
const missing = invalid.filter(Number.isNaN).length;
console.log(sound.length, 'averages, of which', missing, 'are NaN; the last one after 1.8e19 is', huge.at(-1));
assert.deepEqual(new Set(sound), new Set([1]));
assert.ok(missing === 150 && Number.isNaN(invalid.at(-1)));
assert.equal(huge.at(-1), 0);
JAVASCRIPT
timeout 60 node average.cjs

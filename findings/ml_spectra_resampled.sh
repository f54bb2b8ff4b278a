#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# ml-spectra-processing 14.35.1 (npm): a shaft that stands at 100 rad is at 50.5 rad at both ends of a resampled record.
#
# `xyEquallySpaced()` puts a record on an even grid. Expected of an angle of 100 rad throughout: 100 rad. What happens,
# with the default variant "smooth", "the trapezoidal integral divided by the step size": the first and the last value
# are means over a step that lies half outside of the record, where the angle falls to 0 within one sample. From 1 kHz
# to 10 Hz they are 50.5 rad, on the same grid 87.5 rad. With the variant "slot", which "averages y values within each
# bin", a bin without any sample, as during a gap of 0.26 s, is 0 rad. Neither is described.
# Expected of `xyInterpolateLinear()` for times just before and after a ramp from 0 to 10 rad in 1 s: both held, or both
# extrapolated. What happens: -1 rad at -0.1 s, which is extrapolated, and 10 rad at 1.1 s, which is held.
# Output: smooth, 10 Hz: 50.5 100.0 100.0 100.0 100.0 100.0 100.0 100.0 100.0 100.0 50.5
#         smooth, 1 kHz: 87.5 at the first, 100.0 in the middle, 87.5 at the last time
#         slot, 10 Hz, with a gap: 100.0 100.0 100.0 100.0 0.0 0.0 100.0 100.0 100.0 100.0 100.0
#         interpolated at -0.1 s, 0.5 s, 1.1 s: -1.0 5.0 10.0
# For us: let the grid begin and end a step within the record, and cut the record at its gaps beforehand.
#
# Exit code 0: still so. Needs node and npm; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund ml-spectra-processing@14.35.1 > install.log 2>&1 ||
  { cat install.log; exit 1; }
cat > resampled.mjs <<'JS'
import assert from 'node:assert';
import { xyEquallySpaced, xyInterpolateLinear } from 'ml-spectra-processing';

const shown = (values) => Array.from(values, (value) => value.toFixed(1)).join(' ');
const still = (times) => ({ x: times, y: times.map(() => 100) });

const times = Array.from({ length: 1001 }, (_, i) => i / 1000);
const coarse = xyEquallySpaced(still(times), { numberOfPoints: 11 }).y;
console.log('smooth, 10 Hz:', shown(coarse));
assert.strictEqual(shown(coarse), ['50.5', ...Array(9).fill('100.0'), '50.5'].join(' '));

const same = xyEquallySpaced(still(times), { numberOfPoints: 1001 }).y;
const [first, middle, last] = [same[0], same[500], same[1000]].map((value) => value.toFixed(1));
console.log(`smooth, 1 kHz: ${first} at the first, ${middle} in the middle, ${last} at the last time`);
assert.deepStrictEqual([first, middle, last], ['87.5', '100.0', '87.5']);

const within = xyEquallySpaced(still(times), { from: 0.1, to: 0.9, numberOfPoints: 9 }).y;
assert.ok(within.every((value) => Math.abs(value - 100) < 1e-6));

const gap = times.filter((time) => time < 0.32 || time > 0.58);
const slots = xyEquallySpaced(still(gap), { numberOfPoints: 11, variant: 'slot' }).y;
console.log('slot, 10 Hz, with a gap:', shown(slots));
assert.ok(slots.every((value) => value === 0 || Math.abs(value - 100) < 1e-9));
assert.strictEqual(slots.filter((value) => value === 0).length, 2);

const ramp = { x: times, y: times.map((time) => 10 * time) };
const interpolated = shown(xyInterpolateLinear(ramp, [-0.1, 0.5, 1.1]));
console.log('interpolated at -0.1 s, 0.5 s, 1.1 s:', interpolated);
assert.strictEqual(interpolated, '-1.0 5.0 10.0');
JS
timeout 60 node resampled.mjs

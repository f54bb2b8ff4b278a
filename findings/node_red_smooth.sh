#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# node-red-node-smooth 0.1.2 (npm): one null makes 90 rad of a mean of 100 rad, and a deviation of 0.03 mrad is 0.2 mrad
# or NaN.
#
# JSON has no NaN, so that a lost reading is null. By the README, what is no number "will try to be made into a number
# and rejected if that fails". Expected of the mean of 10: null is left out with a remark, as "abc" is. What happens:
# null and an empty text are made into 0, and true into 1: the mean of a joint that stands at 100 rad is 90 rad for 10
# readings. Expected of the standard deviation of ten angles with 0.03 mrad of noise: 0.03 mrad, whatever their mean.
# What happens: it comes from the difference of two sums of squares, which is right at 1 rad, 0.21 mrad at 10 000 rad,
# and NaN at 100 000 rad.
# For us: leave null out before this node, and subtract a fixed angle before a deviation. A made-up runtime of Node-RED
# drives it here.
#
# Exit code 0: still so. Needs node; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts node-red-node-smooth@0.1.2
cat > smooth.mjs <<'JAVASCRIPT'
import assert from 'node:assert';
import { createRequire } from 'node:module';

let Smooth;
const runtime = {
  nodes: {
    createNode(node) {
      node.found = [];
      node.on = (event, action) => { node[event] = action; };
      node.send = (message) => node.found.push(message.payload);
      node.log = (text) => node.found.push(text);
    },
    registerType(name, type) { Smooth = type; },
  },
  util: {
    getMessageProperty: (message, property) => message[property],
    setMessageProperty: (message, property, value) => { message[property] = value; },
  },
};
createRequire(import.meta.url)('node-red-node-smooth/17-smooth.js')(runtime);

function smoothed(action, readings) {
  const node = new Smooth({ action, count: 10 });
  readings.forEach((payload) => node.input({ payload }));
  return node.found;
}

const still = Array(10).fill(100);
for (const [reading, mean] of [[null, 90], ['', 90], [true, 90.1]]) {
  const found = smoothed('mean', [...still, reading]).at(-1);
  console.log('mean with', reading, ':', found);
  assert.ok(Math.abs(found - mean) < 1e-9);
}
assert.match(smoothed('mean', [...still, 'abc']).at(-1), /Not a number/);

function deviation(angle) {
  let state = 1;
  const readings = Array.from({ length: 60 }, () => {
    state = (state * 16807) % 2147483647;
    return angle + 1e-4 * (state / 2147483647 - 0.5);
  });
  const last = readings.slice(-10);
  const mean = last.reduce((sum, reading) => sum + reading) / 10;
  const right = Math.sqrt(last.reduce((sum, reading) => sum + (reading - mean) ** 2, 0) / 9);
  const found = smoothed('sd', readings).at(-1);
  console.log('at', angle, 'rad:', found, 'instead of', right);
  assert.ok(Math.abs(right - 3e-5) < 1e-6);
  return found;
}

assert.ok(Math.abs(deviation(1) - 3e-5) < 1e-6);
assert.ok(deviation(1e4) > 1.9e-4);
assert.ok(Number.isNaN(deviation(1e5)));
JAVASCRIPT
timeout 60 node smooth.mjs

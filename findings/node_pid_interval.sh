#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# node-pid-controller 1.0.1 (npm): two updates within one millisecond count as one second, so that an integral grows
# 1000 times too fast.
#
# A joint is 0.1 rad from its goal for one second, and dt is not set, so that it is calculated from the clock, as the
# README says. Expected: an integral of 0.1 rad·s, whatever the rate. What happens: an interval of 0 is taken as 1 s. At
# the first update, which has no interval, this adds 0.1 rad·s in any case: 0.2 rad·s at 100 Hz. The clock has whole
# milliseconds, so at 2 kHz every other interval is 0, and the integral is 100.2 rad·s. The derivative of an error that
# grows by 1 rad/s is 0.0005 rad/s in one update and 0.5 rad/s in the next.
# For us: always set dt. A clock that is counted up by the test stands here for the clock of the machine.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts node-pid-controller@1.0.1
cat > interval.cjs <<'JAVASCRIPT'
const assert = require('node:assert');
const Controller = require('node-pid-controller');

let now = 1000;
Date.now = () => Math.floor(now);

function outputs(gains, rate, angle) {
  const controller = new Controller(gains);
  controller.setTarget(0.1);
  const found = [];
  for (let update = 0; update <= rate; update++) {
    now = 1000 + (update * 1000) / rate;
    found.push(controller.update(angle(update / rate)));
  }
  return found;
}

const still = () => 0;
for (const [rate, expected] of [[100, 0.2], [2000, 100.2]]) {
  const integral = outputs({ k_p: 0, k_i: 1 }, rate, still).at(-1);
  const given = outputs({ k_p: 0, k_i: 1, dt: 1 / rate }, rate, still).at(-1);
  console.log(rate, 'Hz: integral', integral, 'rad·s, with dt', given, 'rad·s');
  assert.ok(Math.abs(integral - expected) < 1e-6);
  assert.ok(Math.abs(given - 0.1) < 0.002);
}
const speeds = outputs({ k_p: 0, k_d: 1 }, 2000, (time) => -time).slice(-4);
console.log('derivative at 2 kHz', speeds, 'rad/s');
speeds.sort((one, other) => one - other);
[0.0005, 0.0005, 0.5, 0.5].forEach((expected, place) => assert.ok(Math.abs(speeds[place] - expected) < 1e-6));
JAVASCRIPT
timeout 60 node interval.cjs

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pid-controller 1.0.5 (npm): PID.MANUAL starts a controller and PID.AUTOMATIC stops it, and its integral has no limit.
#
# The package offers the constants PID.AUTOMATIC and PID.MANUAL for setMode(). What happens: they are 1 and 0, but
# setMode() takes 0 as automatic and 1 as manual, so that a joint that is set to manual is driven by the controller,
# and one that is set to automatic gets an output of 0. Only the texts 'auto' and 'manual' are right. The library for
# Arduino on which it is based limits its integral to the limits of the output at each step; here only a change of the
# limits does so. After 10 s at an obstacle, with an output limited to 5, the integral is 100, and when the goal is on
# the other side, the joint pushes on for another 10 s. In manual mode, setOutput(9) is not limited to 5 either.
# For us: give the modes as texts, and bring ITerm into the limits of the output after each compute().
#
# Exit code 0: still so. Needs node and npm; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts pid-controller@1.0.5
cat > modes.cjs <<'JS'
const assert = require('node:assert');
const PID = require('pid-controller');

let milliseconds = 0;
PID.prototype.millis = () => milliseconds; // a clock of our own, so that no real time has to pass

/** The output of a controller that is 1 rad away from its goal, with a gain of 10. */
const outputOf = (mode) => {
  const controller = new PID(0, 1, 10, 0, 0, PID.DIRECT);
  controller.setMode(mode);
  milliseconds += 200;
  controller.compute();
  console.log('mode', mode, 'output', controller.getOutput());
  return controller.getOutput();
};

assert.deepStrictEqual(['auto', 'manual', PID.AUTOMATIC, PID.MANUAL].map(outputOf), [10, 0, 0, 10]);

const controller = new PID(0, 1, 0, 10, 0, 'direct');
controller.setOutputLimits(-5, 5);
controller.setMode('auto');
const step = () => {
  milliseconds += 100;
  controller.setInput(0);
  controller.compute();
};
for (let count = 0; count < 100; count++) step();
console.log('integral after 10 s', controller.ITerm, 'output', controller.getOutput());
assert(Math.abs(controller.ITerm - 100) < 1e-9 && controller.getOutput() === 5);
controller.setPoint(-1);
let seconds = 0;
while (controller.getOutput() > 0 && seconds < 60) {
  step();
  seconds += 0.1;
}
console.log('the output is no longer positive after', seconds, 's');
assert(Math.abs(seconds - 10) < 0.11);
controller.setMode('manual');
controller.setOutput(9);
assert(controller.getOutput() === 9);
JS
timeout 60 node modes.cjs

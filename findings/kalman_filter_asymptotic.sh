#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# kalman-filter 2.3.0 (npm): asymptoticGain() gives 0.382 for an encoder whose filter settles at a gain of 0.618.
#
# An observer with a fixed gain needs the gain to which a Kalman filter settles. asymptoticGain() is to give it, as an
# encyclopedia explains it: from the covariance of the prediction. What happens: it is calculated from the covariance
# after the correction, so that the encoder is trusted too little. For a position that wanders by 1 count per sample,
# read with a noise of 1 count, it gives 0.382. The filter settles at 0.618, as the Riccati equation has it. For a
# joint of nearly constant speed at 100 Hz, it gives 0.220 and 3.62 /s where the filter has 0.282 and 4.64 /s.
# For us: let the filter run until its gain no longer changes, and take getGain() of its last prediction.
#
# Exit code 0: still so. Needs node and npm; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts kalman-filter@2.3.0
cat > gain.js <<'JS'
const assert = require('assert');
const { KalmanFilter } = require('kalman-filter');

/** The gain to which the filter settles, and the one that asymptoticGain() gives. */
function gains(dynamic) {
  const filter = new KalmanFilter({ observation: { name: 'sensor', sensorDimension: 1, sensorCovariance: [1] }, dynamic });
  let previousCorrected;
  let predicted;
  for (let sample = 0; sample < 500; sample++) {
    predicted = filter.predict({ previousCorrected });
    previousCorrected = filter.correct({ predicted, observation: [0] });
  }
  const [settled, given] = [filter.getGain({ predicted }), filter.asymptoticGain()].map((gain) => gain.map((row) => row[0]));
  console.log(dynamic.name, 'settles at', settled, 'asymptoticGain', given);
  return [settled, given];
}

/** Whether two lists of numbers are equal within one thousandth. */
const near = (found, expected) => found.every((value, index) => Math.abs(value / expected[index] - 1) < 1e-3);

const [wander, wanderGiven] = gains({ name: 'constant-position', covariance: [1] });
assert(near(wander, [(Math.sqrt(5) - 1) / 2])); // the solution of the Riccati equation
assert(near(wanderGiven, [1 - (Math.sqrt(5) - 1) / 2]));
const [joint, jointGiven] = gains({ name: 'constant-speed', timeStep: 0.01, covariance: [1e-4, 30] });
assert(near(joint, [0.2824, 4.640]) && near(jointGiven, [0.2202, 3.618]));
JS
timeout 60 node gain.js

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# @thi.ng/dsp 4.7.115 (npm): a high-pass lets 91 % of a standstill through, and the response of a low-pass is 30 dB too
# small.
#
# Expected of onepoleHP(0.01), to take the rest position out of a vibration: a joint that stands at 100 rad ends at 0.
# What happens: it ends at 91.2 rad. Its pole is that of a low-pass seen from half the rate, so that at a low corner it
# lets all frequencies through, and at 1/1000 of the rate 91.7 rad. dcBlock(0.01) ends at 0. Expected of
# filterResponse() for onepoleLP(0.01): 0 dB at standstill and -3 dB at the corner, as the filter really has. What
# happens: its pole has the opposite sign in filterCoeffs(), so that the response is -30 dB at both. Those of biquads
# are right.
# For us: take dcBlock() or a biquad as a high-pass; a filter that is chosen by this response is the wrong one.
#
# Exit code 0: still so. Needs node; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts @thi.ng/dsp@4.7.115
cat > onepole.mjs <<'JAVASCRIPT'
import assert from 'node:assert';
import { biquadLP, dcBlock, filterResponse, onepoleHP, onepoleLP } from '@thi.ng/dsp';

/** The output of a filter after 20000 samples of a joint at 100 rad. */
function standing(filter) {
  let output;
  for (let sample = 0; sample < 20000; sample++) {
    output = filter.next(100);
  }
  return output;
}

/** The gain in dB that a filter really has. */
function measured(filter, frequency) {
  let greatest = 0;
  for (let sample = 0; sample < 40000; sample++) {
    const output = Math.abs(filter.next(Math.cos(2 * Math.PI * frequency * sample)));
    greatest = sample > 30000 ? Math.max(greatest, output) : 0;
  }
  return 20 * Math.log10(greatest);
}

const near = (found, expected) => assert.ok(Math.abs(found - expected) < 0.05, `${found} instead of ${expected}`);

const ends = [onepoleHP(0.01), onepoleHP(0.001), dcBlock(0.01), onepoleLP(0.01)].map(standing);
console.log('100 rad behind onepoleHP, a lower one, dcBlock, onepoleLP:', ends);
[91.2, 91.67, 0, 100].forEach((expected, place) => near(ends[place], expected));

const told = [1e-6, 0.01].map((frequency) => filterResponse(onepoleLP(0.01).filterCoeffs(), frequency).mag);
const real = [20 * Math.log10(ends[3] / 100), measured(onepoleLP(0.01), 0.01)];
console.log('onepoleLP(0.01) at standstill and at its corner:', real, 'dB, told', told, 'dB');
[0, -3.01].forEach((expected, place) => near(real[place], expected));
told.forEach((found) => near(found, -30.06));
near(filterResponse(biquadLP(0.01, Math.SQRT1_2).filterCoeffs(), 0.01).mag, -3.01);
JAVASCRIPT
timeout 60 node onepole.mjs

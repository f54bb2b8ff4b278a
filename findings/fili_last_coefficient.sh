#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# fili 2.0.3 (npm): a shaft that stands at 100 rad is at 98.56 rad behind an FIR low-pass of order 10, and at 96.44 rad
# at order 4.
#
# The coefficients of FirCoeffs().lowpass() have a sum of 1. Expected of an FirFilter with them: a constant angle comes
# out as it is once the filter is full. What happens: the last coefficient is never applied, as the memory of the filter
# has one value less than it has coefficients. An angle is too small by the part of this coefficient, and a high-pass of
# order 10 passes 1.44 rad of a constant 100 rad. responsePoint() leaves it out as well, so that it shows the same.
# For us: append a coefficient of 0 to those of the filter. An IirFilter of CalcCascades is right.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts fili@2.0.3
cat > still.cjs <<'JAVASCRIPT'
const assert = require('node:assert');
const { CalcCascades, FirCoeffs, FirFilter, IirFilter } = require('fili');

const ANGLE = 100;
function passed(filter) {
  let angle;
  for (let sample = 0; sample < 3000; sample++) {
    angle = filter.singleStep(ANGLE);
  }
  return angle;
}

const design = new FirCoeffs();
for (const order of [4, 10]) {
  const low = design.lowpass({ order, Fs: 1000, Fc: 10 });
  const sum = low.reduce((total, one) => total + one, 0);
  const angle = passed(new FirFilter(low));
  const padded = passed(new FirFilter([...low, 0]));
  console.log('order', order, 'sum', sum, 'last', low.at(-1), 'angle', angle, 'with a 0 appended', padded);
  assert.ok(Math.abs(sum - 1) < 1e-12 && Math.abs(padded - ANGLE) < 1e-9);
  assert.ok(Math.abs(angle - ANGLE * (1 - low.at(-1))) < 1e-9);
  assert.ok(Math.abs(angle - { 4: 96.44, 10: 98.56 }[order]) < 0.01);
}
const high = passed(new FirFilter(design.highpass({ order: 10, Fs: 1000, Fc: 10 })));
const iir = passed(new IirFilter(new CalcCascades().lowpass({ order: 2, characteristic: 'butterworth', Fs: 1000, Fc: 10 })));
console.log('behind a high-pass', high, 'behind an IIR low-pass', iir);
assert.ok(Math.abs(high - 1.44) < 0.01);
assert.ok(Math.abs(iir - ANGLE) < 1e-6);
JAVASCRIPT
timeout 60 node still.cjs

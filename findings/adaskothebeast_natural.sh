#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# @adaskothebeast/splines 4.0.0 (npm): a shaft that turns evenly stands still in the first interval of a natural spline,
# and is at NaN in the last.
#
# Angles of 1, 3, 5, 7 and 9 rad at 0, 1, 2, 3 and 4 s. Expected of NaturalSpline: the line through them. What happens:
# 1 rad from 0 to 1 s, 3 rad just after, and NaN between 3 s and 4 s, even at 4 s, which is one of its points. In
# between, it joins the points by straight lines, also those of a parabola, as the differences of x are taken where
# those of y are meant. It is documented as "twice continuously differentiable". Its MonotoneCubicHermitInterpolation is
# right.
# For us: interpolate with MonotoneCubicHermitInterpolation of this library.
#
# Exit code 0: still so. Needs node; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts @adaskothebeast/splines@4.0.0
cat > natural.cjs <<'JAVASCRIPT'
const assert = require('node:assert');
const { MonotoneCubicHermitInterpolation, NaturalSpline } = require('@adaskothebeast/splines');

const points = [0, 1, 2, 3, 4].map((time) => [time, 1 + 2 * time]);
const times = [0, 0.5, 1, 1.001, 1.5, 2, 2.5, 3.5, 4];
const values = (Spline) => {
  const spline = new Spline(points);
  const angles = times.map((time) => spline.interpolate(time));
  console.log(Spline.name, times.map((time, index) => `${time} s: ${angles[index].toFixed(3)}`).join(', '));
  return angles;
};
for (const [index, angle] of values(MonotoneCubicHermitInterpolation).entries()) {
  assert.ok(Math.abs(angle - (1 + 2 * times[index])) < 1e-9);
}
const natural = values(NaturalSpline);
assert.deepEqual(natural.slice(0, 3), [1, 1, 1]);
assert.ok(Math.abs(natural[4] - 4) < 1e-9 && Math.abs(natural[6] - 6) < 1e-9);
const parabola = new NaturalSpline([0, 1, 2, 3, 4].map((time) => [time, time ** 2]));
console.log('the square of 2.5 is interpolated as', parabola.interpolate(2.5));
assert.ok(Math.abs(parabola.interpolate(2.5) - 6.5) < 1e-9);
assert.ok(Number.isNaN(natural[7]) && Number.isNaN(natural[8]));
JAVASCRIPT
timeout 60 node natural.cjs

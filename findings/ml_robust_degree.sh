#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# ml-regression-robust-polynomial 3.0.2 (npm): a robust line through the torques and angles of a shaft is a constant, at
# degree 1.
#
# A shaft of 100 N·m/rad, 40 angles, without any noise or outlier. The third argument is documented as "polynomial
# degree". Expected of degree 1: the line, with a stiffness of 100 N·m/rad. What happens: one coefficient, a constant
# torque; a line needs degree 2, and the example of its README gives 3 for a parabola without a word on it. Expected of
# degree 2 for a shaft that stiffens with its angle: no error at all. What happens: a line, another one at each run,
# such as 290, 430 or 600 N·m/rad. ml-regression-polynomial, of the same authors, takes degree 1 as a line.
# For us: give RobustPolynomialRegression the wanted degree plus 1, and look at its number of coefficients.
#
# Exit code 0: still so. Needs node; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts ml-regression-robust-polynomial@3.0.2 \
    ml-regression-polynomial@4.0.0
cat > degree.mjs <<'JAVASCRIPT'
import assert from 'node:assert';
import { RobustPolynomialRegression } from 'ml-regression-robust-polynomial';
import { PolynomialRegression } from 'ml-regression-polynomial';

const angles = Array.from({ length: 40 }, (_, index) => index * 0.001);
const linear = angles.map((angle) => 100 * angle);
const stiffening = angles.map((angle) => 100 * angle + 10000 * angle ** 2);
const worst = (fit, torques) => Math.max(...angles.map((angle, index) => Math.abs(fit.predict(angle) - torques[index])));
const fits = (torques, degree) => [RobustPolynomialRegression, PolynomialRegression].map((Fit) => {
  const fit = new Fit(angles, torques, degree);
  console.log(Fit.name, 'of degree', degree, 'coefficients', fit.coefficients, 'worst error', worst(fit, torques), 'N·m');
  return fit;
});
const [constant, line] = fits(linear, 1);
assert.equal(constant.coefficients.length, 1);
assert.ok(worst(constant, linear) > 1.9 && worst(line, linear) < 1e-9);
const [straight, parabola] = fits(stiffening, 2);
assert.equal(straight.coefficients.length, 2);
assert.ok(worst(straight, stiffening) > 1 && worst(parabola, stiffening) < 1e-6);
const [second] = fits(linear, 2);
assert.ok(worst(second, linear) < 1e-9);
JAVASCRIPT
timeout 60 node degree.mjs

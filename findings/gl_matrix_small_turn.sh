#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# gl-matrix 3.4.4 (npm): the rotation between two directions that are 1.4 mrad apart is none, and the angle between two
# equal poses is NaN.
#
# Expected of quat.rotationTo(), "the shortest rotation from one vector to another": 1.4 mrad, 4.8 arcmin. What happens:
# the identity, as all directions whose dot product is above 0.999999 count as equal; at 1.5 mrad it is exact. Two
# directions that are 1 mrad short of opposite are turned by half a turn exactly. A shaft that is followed in small
# steps this way does not turn at all: 1000 steps of 1 mrad are 0 rad. Expected of quat.getAngle() of a pose and itself:
# 0. What happens: NaN for 85 of 360 poses with numbers of 64 bits, by rounding.
# For us: compute a small angle between directions by atan2() of their cross and dot product.
#
# Exit code 0: still so. Needs node; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts gl-matrix@3.4.4
cat > turn.cjs <<'JAVASCRIPT'
const assert = require('node:assert');
const { glMatrix, quat } = require('gl-matrix');

glMatrix.setMatrixArrayType(Array); // numbers of 64 bits
const direction = (angle) => [Math.cos(angle), Math.sin(angle), 0];
const angle = (turn) => 2 * Math.atan2(Math.hypot(turn[0], turn[1], turn[2]), turn[3]);
const between = (from, to) => {
  const turned = angle(quat.rotationTo(quat.create(), direction(from), direction(to)));
  console.log(`from ${from} to ${to} rad: turned by ${turned} rad`);
  return turned;
};
assert.equal(between(0, 0.0014), 0);
assert.ok(Math.abs(between(0, 0.0015) - 0.0015) < 1e-9);
assert.equal(between(0, Math.PI - 0.001), Math.PI);
const shaft = quat.create();
for (let step = 0; step < 1000; step++) {
  const turn = quat.rotationTo(quat.create(), direction(step * 0.001), direction((step + 1) * 0.001));
  quat.multiply(shaft, turn, shaft);
}
console.log('1000 steps of 1 mrad turn by', angle(shaft), 'rad');
assert.equal(angle(shaft), 0);
const poses = Array.from({ length: 360 }, (_, degrees) => quat.fromEuler(quat.create(), degrees, degrees / 2, degrees / 3));
const unknown = poses.filter((pose) => Number.isNaN(quat.getAngle(pose, pose))).length;
console.log(unknown, 'of 360 poses are at an angle of NaN to themselves');
assert.ok(unknown > 30);
JAVASCRIPT
timeout 60 node turn.cjs

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# math3d 0.2.2 (npm): a flange that points straight down loses its other two angles, and the angle between two equal
# poses is NaN.
#
# Expected of the eulerAngles of Euler(90, 30, 0): three angles of the same pose, as at 89.9°. What happens: x is 90, y
# and z are 0, a pose that is 30° away, and 40° away for Euler(-90, 30, 10). The rest of the angles can be stated as y
# alone where x is ±90°, but it is dropped. Expected of angleTo() of a pose and itself: 0. What happens: NaN for 146 of
# 360 poses, by rounding, and a comparison such as angleTo() > limit is false then.
# For us: compare poses by distanceTo(), and state a pose that points down as a quaternion.
#
# Exit code 0: still so. Needs node; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts math3d@0.2.2
cat > down.cjs <<'JAVASCRIPT'
const assert = require('node:assert');
const { Quaternion } = require('math3d');

const away = (...angles) => {
  const pose = Quaternion.Euler(...angles);
  const { x, y, z } = pose.eulerAngles;
  const dot = Math.min(Math.abs(pose.dot(Quaternion.Euler(x, y, z))), 1);
  const angle = 2 * Math.acos(dot) * 180 / Math.PI;
  console.log(angles, 'are read as', { x, y, z }, 'which is', angle.toFixed(2), '° away');
  return angle;
};
assert.ok(away(89.9, 30, 0) < 0.01);
assert.ok(Math.abs(away(90, 30, 0) - 30) < 0.01);
assert.ok(Math.abs(away(-90, 30, 10) - 40) < 0.01);
const poses = Array.from({ length: 360 }, (_, a) => Quaternion.Euler(a, a / 2, a / 3));
const unknown = poses.filter((pose) => Number.isNaN(pose.angleTo(pose))).length;
console.log(unknown, 'of 360 poses are at an angle of NaN to themselves');
assert.ok(unknown > 50);
JAVASCRIPT
timeout 60 node down.cjs

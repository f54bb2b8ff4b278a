#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# kinematics-js 1.0.8 (npm): a flange that is to be tilted by 17° is turned by half a turn about its own axis.
#
# `inverse()` gives the six joints for a position and an orientation, as rotations about z, x and z again. Expected:
# `forward()` of its joints gives the same pose. What happens: the position is right, but the flange of many poses is
# half a turn about its z axis away from the one that was asked for. Joint 5 is found with a negative sign, of which
# joint 6 takes no account; by the option `flip`, which is on by default, this is mended only where joint 4 is beyond
# 90°. Without `flip` all five of these poses are wrong.
# Output: (4, 3, 9), no tilt: turned by 0°, without flip by 180°
#         (4, 3, 9), tilted by 17° about x: turned by 180°, without flip by 180°
#         (4, -3, 9), tilted by 17° about x: turned by 180°, without flip by 180°
#         (5, 1, 9), turned by 29° about z, tilted by 23°: turned by 180°, without flip by 180°
#         (0, 5, 9), tilted by 11° about x: turned by 0°, without flip by 180°
# For us: pass the joints that `inverse()` gives to `forward()`, and turn joint 6 by half a turn where the pose differs.
#
# Exit code 0: still so. Needs node and npm; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund kinematics-js@1.0.8 > install.log 2>&1 || { cat install.log; exit 1; }
cat > flange.mjs <<'JS'
import assert from 'node:assert';
import { forward, inverse } from 'kinematics-js/dist/esm/index.js';

const ROBOT = { base: 1, v1: 2.5, v2: 3, v3: 2.5, v4: 2.5, v5: 2.5, v6: 2 };

const rotation = (first, tilt, second) => {
  const [ca, sa, cb, sb] = [Math.cos(first), Math.sin(first), Math.cos(tilt), Math.sin(tilt)];
  const [cc, sc] = [Math.cos(second), Math.sin(second)];
  return [
    [ca * cc - sa * cb * sc, -ca * sc - sa * cb * cc, sa * sb],
    [sa * cc + ca * cb * sc, -sa * sc + ca * cb * cc, -ca * sb],
    [sb * sc, sb * cc, cb],
  ];
};
/** By how many degrees the flange is turned about its axis from the pose that was asked for; its place is checked. */
const turned = (pose, flip) => {
  const found = forward(...inverse(...pose, { ...ROBOT, flip }), { ...ROBOT });
  const goal = rotation(...pose.slice(3));
  let trace = 0;
  for (let row = 0; row < 3; row += 1) {
    assert.ok(Math.abs(found[row][3] - pose[row]) < 1e-3);
    assert.ok(Math.abs(found[row][2] - goal[row][2]) < 1e-3);
    for (let column = 0; column < 3; column += 1) trace += found[row][column] * goal[row][column];
  }
  return Math.round((Math.acos(Math.min(1, Math.max(-1, (trace - 1) / 2))) * 180) / Math.PI);
};
for (const [name, pose, expected] of [
  ['(4, 3, 9), no tilt', [4, 3, 9, 0, 0, 0], 0],
  ['(4, 3, 9), tilted by 17° about x', [4, 3, 9, 0, 0.3, 0], 180],
  ['(4, -3, 9), tilted by 17° about x', [4, -3, 9, 0, 0.3, 0], 180],
  ['(5, 1, 9), turned by 29° about z, tilted by 23°', [5, 1, 9, 0.5, 0.4, 0], 180],
  ['(0, 5, 9), tilted by 11° about x', [0, 5, 9, 0, 0.2, 0], 0],
]) {
  const found = [turned(pose, true), turned(pose, false)];
  console.log(`${name}: turned by ${found[0]}°, without flip by ${found[1]}°`);
  assert.deepStrictEqual(found, [expected, 180]);
}
JS
timeout 60 node flange.mjs

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# roslib 2.1.0 (npm): a joint 0.3 m above its parent is at 0 if two spaces stand between the numbers in its URDF.
#
# People align the numbers of an origin in columns with more than one space, which urdfdom, the parser of ROS, skips.
# Expected of xyz="0  0  0.3" rpy="0  0  1.57": the same pose as with single spaces. What happens: UrdfModel splits the
# text at each single space and takes the empty pieces as missing numbers, so that the origin is (0, 0, 0) and not
# turned, without a warning. The same holds for a space before the first number. An axis with two spaces is an error.
# For us: put single spaces into the URDF before UrdfModel reads it: text.replace(/\s+/g, ' ').
#
# Exit code 0: still so. Needs node; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund --ignore-scripts roslib@2.1.0
cat > read.mjs <<'JS'
import assert from 'node:assert';
import { UrdfModel } from 'roslib';

function joint(xyz, rpy, axis) {
  const string = `<robot name="arm"><link name="base"/><link name="tip"/>
    <joint name="elbow" type="continuous"><parent link="base"/><child link="tip"/>
    <origin xyz="${xyz}" rpy="${rpy}"/><axis xyz="${axis}"/></joint></robot>`;
  const { origin } = new UrdfModel({ string }).joints.elbow;
  const yaw = 2 * Math.atan2(origin.orientation.z, origin.orientation.w);
  return [origin.position.z, Math.round(yaw * 1e6) / 1e6];
}

const found = {
  single: joint('0 0 0.3', '0 0 1.57', '0 0 1'),
  double: joint('0  0  0.3', '0  0  1.57', '0 0 1'),
  before: joint(' 0 0 0.3', ' 0 0 1.57', '0 0 1'),
};
console.log('Height and yaw:', found);
assert.deepStrictEqual(found, { single: [0.3, 1.57], double: [0, 0], before: [0, 0] });
assert.throws(() => joint('0 0 0.3', '0 0 1.57', '0  0  1'), /three numbers/);
JS
timeout 60 node read.mjs

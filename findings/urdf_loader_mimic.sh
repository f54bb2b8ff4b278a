#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# urdf-loader 0.13.1: a mimic begins without its offset, and a mimic of a mimic goes beyond the stop of the joint that
# it follows.
#
# An output follows a motor by -0.05 with an offset of 0.03, from -0.1 to 0.1 rad; a pointer follows the output by 2
# with an offset of 0.2. A loaded robot shows all three at 0, until a joint is set. At 100 rad of the motor the output
# stops at -0.1; the pointer should stand at 0, and is at -9.74: it follows where the output would be without its limit.
# Where the output is set, it turns without the motor.
# For us: set the motor once after loading, give mimics no limits of their own, and let each mimic the motor itself.
#
# Exit code 0: still so. Needs node; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts urdf-loader@0.13.1 three@0.187.0 jsdom@26.1.0
cat > mimic.mjs <<'JAVASCRIPT'
import assert from 'node:assert';
import { JSDOM } from 'jsdom';
const { window } = new JSDOM('');
for (const name of ['DOMParser', 'Document', 'Element']) globalThis[name] = window[name];
globalThis.document = window.document;
const { default: URDFLoader } = await import('urdf-loader');

const robot = new URDFLoader().parse(`<robot name="gear">
  <link name="stator"/><link name="rotor"/><link name="shaft"/><link name="hand"/>
  <joint name="motor" type="continuous"><parent link="stator"/><child link="rotor"/><axis xyz="0 0 1"/></joint>
  <joint name="output" type="revolute"><parent link="stator"/><child link="shaft"/><axis xyz="0 0 1"/>
    <limit lower="-0.1" upper="0.1" effort="1" velocity="1"/><mimic joint="motor" multiplier="-0.05" offset="0.03"/></joint>
  <joint name="pointer" type="continuous"><parent link="shaft"/><child link="hand"/><axis xyz="0 0 1"/>
    <mimic joint="output" multiplier="2" offset="0.2"/></joint>
</robot>`);
const angles = () => Object.values(robot.joints).map((joint) => Math.round(joint.angle * 1000) / 1000);
const shown = { loaded: angles() };
for (const [name, angle] of [['motor', 0], ['motor', 100], ['output', 0.05]]) {
  robot.setJointValue(name, angle);
  shown[`${name} to ${angle}`] = angles();
}
console.log(shown);
assert.deepEqual(Object.values(shown), [[0, 0, 0], [0, 0.03, 0.26], [100, -0.1, -9.74], [100, 0.05, 0.3]]);
JAVASCRIPT
timeout 60 node mimic.mjs

#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# gcode-toolpath 3.0.0 (npm): an axis that "G0 G90 X10" sends to 10 stays at 0, and an arc by G90.1 gets another centre.
#
# By RS274/NGC (NIST IR 6556, on the order of items) the words of a line may be reordered without changing its meaning,
# so that "G0 G90 X10" and "G90 G0 X10" are the same move; CAM programs write either. What happens: each word goes to
# the G or M word that stands before it. X10 behind G90 or M3 is dropped without a warning, and all relative moves that
# follow are off. With G90.1 the centre of an arc is absolute, but it is added to the start. After G92 X0 at X5, an arc
# in the ZX plane is moved by 5 along Z instead of X.
# For us: a reference path for an axis is wrong so. Put the axes' words behind G0 or G1, and I and J by G91.1.
#
# Exit code 0: still so. Needs node; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund --ignore-scripts gcode-toolpath@3.0.0 gcode-interpreter@3.0.0 gcode-parser@2.2.0
cat > path.cjs <<'JS'
const assert = require('node:assert');
const module_ = require('gcode-toolpath');
const Toolpath = module_.default || module_;

function run(text) {
  const arcs = [];
  const path = new Toolpath({ addArcCurve: (modal, start, end, centre) => arcs.push({ modal: { ...modal }, start, end, centre }) });
  path.loadFromStringSync(text);
  const { x, y, z } = path.getPosition();
  return { at: [x, y, z], arcs };
}

for (const [text, right, found] of [
  ['G90 G0 X10 Y10', [10, 10, 0], [10, 10, 0]],
  ['G0 G90 X10 Y10', [10, 10, 0], [0, 0, 0]],
  ['G1 F600 G91 X10\nG1 X10', [20, 0, 0], [10, 0, 0]],
  ['G1 M3 S100 X10', [10, 0, 0], [0, 0, 0]],
]) {
  const { at } = run(text);
  console.log(JSON.stringify(text), 'right', right, 'found', at);
  assert.deepStrictEqual(at, found);
}

const absolute = run('G90 G0 X10\nG90.1\nG2 X20 Y0 I15 J0').arcs[0];
console.log('centre by G90.1, right 15:', absolute.centre.x);
assert.ok(absolute.centre.x === 25);

// The coordinates of an arc in the ZX plane are given in the order z, x, y.
const plain = run('G0 X5\nG18 G2 X15 Z0 I5 K0').arcs[0];
const shifted = run('G0 X5\nG92 X0\nG18 G2 X10 Z0 I5 K0').arcs[0];
console.log('arc in ZX', plain.start, 'the same one after G92 X0', shifted.start);
assert.deepStrictEqual(plain.start, { x: 0, y: 5, z: 0 });
assert.deepStrictEqual(shifted.start, { x: 5, y: 0, z: 0 });
JS
timeout 60 node path.cjs

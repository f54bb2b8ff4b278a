#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# gcode-toolpath 3.0.0: after G92 X10, an arc in the ZX plane is moved along Z and not along X, and the same in YZ.
#
# Expected of a line, an arc and a line: each begins where the one before it ends, and G92 X10 at 0 moves all of them by
# -10 along X, as it moves no axis itself. What happens: for an arc the coordinates are turned so that the plane comes
# first (Z, X, Y for G18), and only then is the offset added, still as X, Y, Z: the arc which ends at Z 5, X 5 is given
# at Z -5, X 15, while the line after it begins at Z 5, X 5. In the plane YZ (Y, Z, X) the offset of X goes to Y.
# Without G92, and in the plane XY, it is right.
# For us: a path with such arcs jumps, by the offset along two axes. Shift the coordinates of the program, without G92.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export HOME="$folder" npm_config_loglevel=error
npm install --no-audit --no-fund --silent --ignore-scripts \
  gcode-toolpath@3.0.0 gcode-interpreter@3.0.0 gcode-parser@2.2.0
cat > check.js <<'JS'
const assert = require('assert');
const Toolpath = require('gcode-toolpath');

// In each plane a line, a quarter of a circle with a radius of 5, and a line. An arc is given as `order` says.
const planes = {
  G17: {order: 'xyz', move: 'G1 X0 Y0', arc: 'G2 X5 Y5 I5 J0', line: 'G1 X9'},
  G18: {order: 'zxy', move: 'G1 Z0 X0', arc: 'G2 Z5 X5 K5 I0', line: 'G1 X9'},
  G19: {order: 'yzx', move: 'G1 Y0 Z0', arc: 'G2 Y5 Z5 J5 K0', line: 'G1 Y9'},
};

function gap(plane, offset) {
  const {order, move, arc, line} = planes[plane];
  const found = [];
  const toolpath = new Toolpath({
    addLine: (modal, from, to) => found.push({from, to}),
    addArcCurve: (modal, from, to) => {
      const back = v => Object.fromEntries([...order].map((name, i) => [name, v['xyz'[i]]]));
      found.push({from: back(from), to: back(to)});
    },
  });
  const shifted = [move, arc, line].map(text => text.replace(/X(\d+)/, (_, x) => `X${Number(x) + offset}`));
  const program = [offset ? `G92 X${offset}` : 'G21', plane, ...shifted];
  toolpath.loadFromStringSync(program.join('\n'));
  assert.strictEqual(found.length, 3);
  const [end, next] = [found[1].to, found[2].from];
  const jump = ['x', 'y', 'z'].map(name => next[name] - end[name]);
  console.log(`${program.join(', ')}: arc to ${JSON.stringify(end)}, next from ${JSON.stringify(next)}`);
  return jump;
}

for (const plane of Object.keys(planes)) assert.deepStrictEqual(gap(plane, 0), [0, 0, 0]);
assert.deepStrictEqual(gap('G17', 10), [0, 0, 0]);
assert.deepStrictEqual(gap('G18', 10), [-10, 0, 10]);
assert.deepStrictEqual(gap('G19', 10), [-10, 10, 0]);
JS
timeout 60 node check.js

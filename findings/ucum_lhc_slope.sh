#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# @lhncbc/ucum-lhc 7.1.10 (npm): a slope of 100 % is an angle of 0.785° instead of 45°, and 45° are a slope of 162 %.
#
# UCUM defines %[slope] by 100 tan(α) and arctan(x/100) for a plane angle α. Expected of a slope of 100 %: 45°, or
# 0.785 rad. What happens: 0.785°, or 0.0137 rad, as arctan() gives radians that are taken for degrees; and 45°, 60° and
# 80° are slopes of 162 %, 32 % and 900 % (100 %, 173 % and 567 % are right), as tan() is given degrees. The status is
# "succeeded". UCUM's table says "deg" of %[slope] in one place and "rad" in another; by its text 100 % are 45°.
# Degrees, seconds of arc, gons and turns are right.
# For us: convert slopes by Math.atan() before they are given to it.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund @lhncbc/ucum-lhc@7.1.10 > /dev/null
cat > slope.js <<'JS'
const assert = require('node:assert');
const ucum = require('@lhncbc/ucum-lhc').UcumLhcUtils.getInstance();

function converted(value, from, to, expected) {
  const answer = ucum.convertUnitTo(from, value, to);
  console.log(`${value} ${from} = ${answer.toVal} ${to} (${answer.status})`);
  assert.equal(answer.status, 'succeeded');
  assert(Math.abs(answer.toVal - expected) < 1e-9 * Math.abs(expected), `${expected} was seen`);
}

converted(100, '%[slope]', 'deg', Math.PI / 4);
converted(100, '%[slope]', 'rad', Math.PI / 4 * Math.PI / 180);
for (const degrees of [45, 60, 80]) converted(degrees, 'deg', '%[slope]', 100 * Math.tan(degrees));
converted(180, 'deg', 'rad', Math.PI);
converted(3600, "''", 'deg', 1);
converted(200, 'gon', 'rad', Math.PI);
converted(1, 'circ', 'deg', 360);
JS
timeout 60 node slope.js

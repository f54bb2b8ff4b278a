#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# @atomic-ehr/ucum 0.2.5 (npm): 20 dB[V] are 1 000 000 000 V instead of 10 V, and 1 Cel/min is 273.2 K/min.
#
# Its README lists metric prefixes and "logarithmic, and other special units". Expected: 20 dB[V] are 10 V, 30 dB[W] are
# 1000 W, 94 dB[SPL] are 1 Pa and 10 dNp are 1 Np, as @lhncbc/ucum-lhc gives. What happens: 1e9 V, 1e29 W, 1e41 Pa and
# 10 Np, without an error, as the prefix multiplies the result, or is dropped, instead of dividing the number of the
# level; back, 1000 W are 4 dB[W]. Without a prefix, 2 B[V] are 10 V, which is right, but 2 B[SPL] are half of their
# 0.0002 Pa. 20 dB of no unit are right. And UCUM does not allow °C in a product, but 1 Cel/min, of a motor that gets
# warmer, is valid by validate() and 273.2 K/min by convert(); ucum-lhc refuses it.
# For us: divide levels in dB by 10 and give them in B, not B[SPL]; take K for differences of temperature.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund @atomic-ehr/ucum@0.2.5 @lhncbc/ucum-lhc@7.1.10 > /dev/null
cat > levels.mjs <<'JS'
import assert from 'node:assert';
import { createRequire } from 'node:module';
import { ucum } from '@atomic-ehr/ucum';

const lhc = createRequire(import.meta.url)('@lhncbc/ucum-lhc').UcumLhcUtils.getInstance();

for (const [value, from, to, right, seen] of [
  [20, 'dB[V]', 'V', 10, 1e9],
  [30, 'dB[W]', 'W', 1000, 1e29],
  [1000, 'W', 'dB[W]', 30, 4],
  [94, 'dB[SPL]', 'Pa', 1.0023744672545447, 1e41],
  [10, 'dNp', 'Np', 1, 10],
  [2, 'B[V]', 'V', 10, 10],
  [2, 'B[SPL]', 'Pa', 2e-4, 1e-4],
  [20, 'dB', '1', 100, 100],
  [1, 'Cel/min', 'K/min', null, 273.16666666666663],
]) {
  const found = ucum.convert(value, from, to);
  const other = lhc.convertUnitTo(from, value, to);
  console.log(`${value} ${from} = ${found} ${to}; by ucum-lhc ${other.toVal ?? other.msg[0]}`);
  assert(Math.abs(found / seen - 1) < 1e-9);
  if (right === null) assert.notEqual(other.status, 'succeeded');
  else assert(Math.abs(other.toVal / right - 1) < 1e-9);
}
assert(ucum.validate('Cel/min').valid);
JS
timeout 60 node levels.mjs

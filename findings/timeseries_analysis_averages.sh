#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# timeseries-analysis 1.0.12 (npm): an exponential average is one of two readings, a weighted one favours the oldest.
#
# ema() and lwma() are moving averages of a recording. Expected of ema({period: 12}): each value is 2/13 of the new
# reading and 11/13 of the value before, so that a count that trembles by ±1 evenly from one reading to the next is at
# ±0.08. What happens: it is 2/13 of the new reading and 11/13 of the reading before, at ±0.69, and an outlier of 4096
# counts is still 3466 one reading later. Expected of lwma({period: 12}): the weights fall from 12 for the new reading
# to 1. What happens: they rise from 1 for the reading before to 12 for the oldest, and the new reading does not
# count, so that a shaft that turns by 10 counts per reading is 83 counts behind instead of 37.
# For us: compute y += 2 / 13 * (x - y) for each reading.
#
# Exit code 0: still so. Needs node and npm; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts timeseries-analysis@1.0.12
cat > averages.cjs <<'JS'
const assert = require('node:assert');
const timeseries = require('timeseries-analysis');

/** The values of a method of the package for the given readings. */
const averaged = (method, readings) => {
  const series = new timeseries.main(readings.map((reading, sample) => [new Date(10 * sample), reading]));
  return series[method]({ period: 12 }).output().map(([, value]) => value);
};

/** The exponential average of the textbook. */
const exponential = (readings) => {
  let value = readings[0];
  return readings.map((reading) => (value += (2 / 13) * (reading - value)));
};

/** The linearly weighted average of the textbook. */
const weighted = (readings) =>
  readings.map((_, sample) => {
    let sum = 0;
    for (let age = 0; age < 12; age++) sum += (12 - age) * (readings[sample - age] ?? NaN);
    return sum / 78;
  });

const near = (found, expected) => assert(Math.abs(found - expected) < 0.01 * Math.max(1, Math.abs(expected)), `${found}`);
const trembling = Array.from({ length: 200 }, (_, sample) => (sample % 2 ? 1 : -1));
let [given, right] = [averaged('ema', trembling)[199], exponential(trembling)[199]];
console.log('trembling', given, 'right', right);
near(Math.abs(given), 9 / 13);
near(Math.abs(right), 1 / 12);
const outlier = Array.from({ length: 200 }, (_, sample) => (sample === 100 ? 4096 : 0));
[given, right] = [averaged('ema', outlier).slice(100, 103), exponential(outlier).slice(100, 103)];
console.log('outlier', given, 'right', right);
[(4096 * 2) / 13, (4096 * 11) / 13, 0].forEach((expected, sample) => near(given[sample], expected));
const turning = Array.from({ length: 200 }, (_, sample) => 10 * sample);
[given, right] = [1990 - averaged('lwma', turning)[199], 1990 - weighted(turning)[199]];
console.log('counts behind', given, 'right', right);
near(given, 250 / 3);
near(right, 110 / 3);
JS
timeout 60 node averages.cjs

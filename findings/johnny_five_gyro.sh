#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# johnny-five 2.1.0: with an MPU-6050, a turn of an arm by 91° is found as 48°.
#
# The rate of a Gyro is right, 90° a second. Its angle, as in gyro.yaw.angle, is the sum of the rates divided by 100,
# whatever the time between two samples. An Arduino with Firmata sends them each 19 ms, unless samplingInterval() is
# changed, so that the angle is 0.53 of the real one; at 20 ms half of it. Only at 10 ms is it right. An IO plugin here
# gives the samples of a board at 19 ms.
# For us: a link whose turn is found by it has a gear ratio of 0.53; sum rates up by their own times.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts johnny-five@2.1.0
cat > turn.cjs <<'JAVASCRIPT'
const assert = require('node:assert');
const { EventEmitter } = require('node:events');
const { Board, Gyro } = require('johnny-five');

class Arduino extends EventEmitter {
  constructor() {
    super();
    Object.assign(this, { name: 'Arduino', isReady: true, pins: [], analogPins: [], MODES: {}, HIGH: 1, LOW: 0 });
  }
  i2cConfig() {}
  i2cWrite() {}
  i2cRead(address, register, length, sample) {
    this.sample = (degreesPerSecond) => {
      const data = Buffer.alloc(length);
      data.writeInt16BE(131 * degreesPerSecond, 12); // the rate about z, in the range of ±250°/s
      sample([...data]);
    };
  }
}

process.exitCode = 1; // until the end is reached
const io = new Arduino();
const board = new Board({ io, repl: false, debug: false, sigint: false });
board.on('ready', () => {
  const gyro = new Gyro({ controller: 'MPU6050' });
  for (let sample = 0; sample < 101; sample++) io.sample(0); // at rest, for the calibration
  const interval = 0.019;
  let turned = 0;
  for (; turned < 90; turned += 90 * interval) io.sample(90);
  const { rate, angle } = gyro.yaw;
  for (let sample = 0; sample < 10; sample++) io.sample(0);
  console.log('turned', turned, 'rate', rate, 'angle', angle, 'and at rest again', gyro.yaw.angle);
  assert.equal(rate, 90);
  assert.ok(gyro.isCalibrated);
  assert.ok(Math.abs(gyro.yaw.angle - (turned / interval) * 0.01) < 0.1);
  assert.ok(turned > 90 && gyro.yaw.angle < 48);
  process.exit(0);
});
JAVASCRIPT
timeout 60 node turn.cjs

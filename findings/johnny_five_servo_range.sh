#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# johnny-five 2.1.0: a servo of ±90° that is sent to its centre turns to 90°, and one of 270° stops at 180°.
#
# Expected of a Servo with degreeRange [-90, 90], without another range: center() sends it to 0°, as home() does, and
# to(-45) to -45°. What happens: its range is 0° to 180°, whatever degreeRange is, which is first taken over and then
# overwritten. center() is 90°, min() is 0°, to(-45) is 0°, and max() is 180°, for which 3300 µs are sent where 2400 µs
# are the greatest. With degreeRange [0, 270], center() is 90° instead of 135°, and to(270) is 180°.
# Expected of step(-10), which "moves the servo step degrees relative to current position", at the stop of 180°: 170°.
# What happens: after five steps of 10° beyond the stop, which do not move it, the servo turns back at the sixth step
# only. An IO plugin here keeps what the pins are sent.
# For us: give `range` as well as degreeRange, and goals by to().
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts johnny-five@2.1.0
cat > servo.cjs <<'JAVASCRIPT'
const assert = require('node:assert');
const { EventEmitter } = require('node:events');
const { Board, Servo } = require('johnny-five');

class Arduino extends EventEmitter {
  constructor() {
    super();
    Object.assign(this, { name: 'Arduino', isReady: true, analogPins: [], MODES: { SERVO: 4 }, HIGH: 1, LOW: 0 });
    this.pins = Array.from({ length: 12 }, () => ({ supportedModes: [4] }));
  }
  pinMode() {}
  servoWrite(pin, microseconds) {
    this.pulse = microseconds;
  }
}

process.exitCode = 1; // until the end is reached
const io = new Arduino();
const board = new Board({ io, repl: false, debug: false, sigint: false });
board.on('ready', () => {
  const moved = (options, ...moves) => {
    const servo = new Servo({ pin: 9, ...options });
    const found = moves.map(([name, ...goal]) => {
      servo[name](...goal);
      return [servo.position, io.pulse];
    });
    const calls = moves.map(([name, ...goal]) => `${name}(${goal})`);
    console.log(JSON.stringify(options), calls.join(' '), found.join(' | '));
    return found;
  };
  const moves = [['center'], ['home'], ['min'], ['max'], ['to', -45]];
  const degreeRange = [-90, 90];
  const right = [[0, 1500], [0, 1500], [-90, 600], [90, 2400], [-45, 1050]];
  assert.deepEqual(moved({ degreeRange, range: degreeRange }, ...moves), right);
  const found = [[90, 2400], [0, 1500], [0, 1500], [180, 3300], [0, 1500]];
  assert.deepEqual(moved({ degreeRange }, ...moves), found);
  assert.deepEqual(moved({ degreeRange: [0, 270] }, ['center'], ['to', 270]), [[90, 1200], [180, 1800]]);

  const beyond = Array(5).fill(['step', 10]);
  const steps = moved({}, ['to', 180], ...beyond, ...Array(6).fill(['step', -10])).map(([degrees]) => degrees);
  assert.deepEqual(steps, [...Array(11).fill(180), 170]);
  process.exit(0);
});
JAVASCRIPT
timeout 60 node servo.cjs

#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# johnny-five 2.1.0: a servo of 270° that is sent to 135°, its middle, turns to 202.5°, as `deviceRange` has no effect.
#
# The documentation of Servo has deviceRange, "the physical range of the servo in degrees", and range, "the range of
# motion in degrees". Expected with both at [0, 270]: to(135) sends 1500 µs, the middle of 600 to 2400 µs, and to(270)
# sends 2400 µs. What happens: the code has another name for this option, degreeRange, and does not read deviceRange. It
# takes each servo as one of 180°: 1950 µs are sent for 135°, and 3300 µs, which is beyond the greatest pulse, for 270°.
# The servo of 6.75 turns in the example servo-multi-turn turns by 3.375 turns where the example sends it to 90°.
# Expected of step(-10), which "moves the servo step degrees relative to current position", at the stop of 180°: 170°.
# What happens: after five steps of 10° beyond the stop, which do not move it, the servo turns back at the sixth step
# only. An IO plugin here keeps what the pins are sent.
# For us: give the physical range as degreeRange, and goals by to().
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
  servoConfig() {}
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
  const [range, moves] = [[0, 270], [['to', 135], ['to', 270]]];
  assert.deepEqual(moved({ range, degreeRange: range }, ...moves), [[135, 1500], [270, 2400]]);
  assert.deepEqual(moved({ range, deviceRange: range }, ...moves), [[135, 1950], [270, 3300]]);
  const turns = 6.75 * ((moved({ pwmRange: [600, 2370], deviceRange: [0, 2430] }, ['to', 90])[0][1] - 600) / 1770);
  assert.equal(turns, 3.375);

  const beyond = Array(5).fill(['step', 10]);
  const steps = moved({}, ['to', 180], ...beyond, ...Array(6).fill(['step', -10])).map(([degrees]) => degrees);
  assert.deepEqual(steps, [...Array(11).fill(180), 170]);
  process.exit(0);
});
JAVASCRIPT
timeout 60 node servo.cjs

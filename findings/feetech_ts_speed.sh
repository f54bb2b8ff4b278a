#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# feetech-servo-ts 1.0.0 (npm): a speed of 60 rpm is 538 for an STS3215, which turns at 7.9 rpm then.
#
# An STS3215 has its speed in counts per second, of 4096 a turn: 60 rpm are 4096. helpers.rpmToSpeed(60) is 538 and
# speedToRpm(4096) 456 rpm, by the scale of another servo, of 1023 for 114 rpm; clampSpeed() ends at 1023, 15 rpm. A
# speed back has its sign in bit 15, so that readStatus() gives -50 as 32818, and a load of -100, with its sign in bit
# 10, as 1124. By the README degrees go from 0 to 300; they go from 0 to 360. A port answers here as a servo does.
# For us: take the raw speed by 2 π / 4096 rad/s.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts feetech-servo-ts@1.0.0
cat > read.cjs <<'JAVASCRIPT'
const assert = require('node:assert');

const registers = Buffer.alloc(256);
registers.writeUInt16LE(2048, 56);
registers.writeUInt16LE(0x8000 | 50, 58);
registers.writeUInt16LE(0x0400 | 100, 60);
let answers;
const readable = new ReadableStream({ start: (controller) => { answers = controller; } });
const writable = new WritableStream({
  write([, , number, , instruction, address, length]) {
    const content = instruction === 2 ? [...registers.subarray(address, address + length)] : [];
    const body = [number, content.length + 2, 0, ...content];
    const check = ~body.reduce((sum, byte) => sum + byte) & 0xff;
    answers.enqueue(Uint8Array.from([0xff, 0xff, ...body, check]));
  },
});
const port = { readable, writable, open: async () => {} };
Object.defineProperty(globalThis, 'navigator', { value: { serial: { requestPort: async () => port } } });
const { FeetechServo, helpers } = require('feetech-servo-ts');

(async () => {
  const servo = new FeetechServo();
  await servo.connect();
  const status = await servo.readStatus(1);
  const rates = [helpers.rpmToSpeed(60), helpers.speedToRpm(4096), helpers.clampSpeed(4096)];
  console.log('60 rpm', rates[0], '4096 counts/s', rates[1], 'rpm, clamped', rates[2]);
  console.log('at 2048 counts, a speed of -50 and a load of -100:', status);
  assert.strictEqual(rates[0], 538);
  assert.ok(Math.abs(rates[1] - 456.4) < 0.1);
  assert.strictEqual(rates[2], 1023);
  assert.deepStrictEqual([status.position, status.speed, status.load], [2048, 32818, 1124]);
  assert.strictEqual(await servo.getPositionInDegrees(1), 180);
  process.exit(0);
})();
JAVASCRIPT
timeout 60 node read.cjs

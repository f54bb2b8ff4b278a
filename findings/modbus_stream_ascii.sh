#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# modbus-stream 0.46.0 (npm): in Modbus ASCII, a position of 1000 that was disturbed on its way is read as -31768.
#
# Each frame of Modbus ASCII ends with the LRC, the check by which the specification has a receiver discard a frame that
# was disturbed on its way. Expected of an answer whose LRC does not fit: an error after the time-out, as in RTU, where
# the same disturbed byte is refused by its CRC. What happens: the LRC is computed, but not compared, and the disturbed
# position is given to the caller as a good one. The answer to function 11, which counts the messages that a drive has
# received, has two bytes of status and two of the count. Expected of a count of 264: 264. What happens: the first two
# bytes are taken as status and count, so that the count is 0 of a drive that is ready, and 255 of one that is busy.
# An object that answers takes the place of the serial port. For us: use RTU or TCP.
#
# Exit code 0: still so. Needs node and npm; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund modbus-stream@0.46.0 > install.log 2>&1 || { cat install.log; exit 1; }
cat > read.js <<'JS'
const assert = require('assert');
const { EventEmitter } = require('events');
const { transports } = require('modbus-stream');
const Stream = require('modbus-stream/lib/stream');

// A frame of ASCII or RTU around the bytes of an answer, of which one may be disturbed behind the check.
function ascii(bytes, disturb) {
  const lrc = -bytes.reduce((sum, byte) => sum + byte, 0) & 0xff;
  return Buffer.from(`:${Buffer.from(disturb([...bytes, lrc])).toString('hex').toUpperCase()}\r\n`);
}

function rtu(bytes, disturb) {
  const crc = transports.serial.crc16(Buffer.from(bytes));
  return Buffer.from(disturb([...bytes, crc & 0xff, crc >> 8]));
}

class Port extends EventEmitter {
  write(data, next) {
    next();
    setImmediate(() => this.emit('data', this.answer));
  }
}

function ask(Transport, frame, bytes, disturb, method) {
  const port = new Port();
  port.answer = frame(bytes, disturb);
  const stream = new Stream(new Transport(port, { retry: 300 }), { debug: null });
  return new Promise((resolve) => {
    setTimeout(() => stream[method]({ address: 0, quantity: 1 }, (error, answer) => {
      resolve(error ? error.message : answer.response);
    }), 20);
  });
}

async function position(Transport, frame, disturb) {
  const answer = await ask(Transport, frame, [1, 3, 2, 0x03, 0xe8], disturb, 'readHoldingRegisters');
  return answer.data ? answer.data[0].readInt16BE() : answer;
}

const intact = (bytes) => bytes;
const disturbed = (bytes) => bytes.with(3, bytes[3] ^ 0x80);

(async () => {
  const found = {};
  for (const [name, Transport, frame] of [['RTU', transports.serial, rtu], ['ASCII', transports.ascii, ascii]]) {
    found[name] = [await position(Transport, frame, intact), await position(Transport, frame, disturbed)];
  }
  console.log('Intact and disturbed:', found);
  assert.deepStrictEqual(found.ASCII, [1000, -31768]);
  assert.strictEqual(found.RTU[0], 1000);
  assert.strictEqual(typeof found.RTU[1], 'string');

  const counts = [];
  for (const status of [0x00, 0xff]) {
    const bytes = [1, 11, status, status, 0x01, 0x08];
    counts.push((await ask(transports.serial, rtu, bytes, intact, 'getCommEventCounter')).event_count);
  }
  console.log('A count of 264, ready and busy:', counts);
  assert.deepStrictEqual(counts, [0, 255]);
  process.exit(0);
})();
JS
timeout 60 node read.js

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# ads-client 2.1.0 (npm): writing an array of 3 by 4 angles to a TwinCAT PLC also sets the 84 LREAL behind it to 0.
#
# MAIN.poses is an ARRAY [0..2,0..3] OF LREAL, which are 96 bytes, and MAIN.speed the LREAL behind it. Expected of
# writeValue('MAIN.poses', ...): 96 bytes. What happens: the size of an element is multiplied in for each dimension, so
# that 768 bytes are written, those behind the first 96 as zeros, and the speed of 2.5 becomes 0, as ADS writes by an
# address and a length, not by a symbol. The array itself is read back right, and nothing warns. With one dimension, the
# same twelve angles are written as 96 bytes. A server that gives its symbols and types, and reads and writes its memory
# where it is told to, takes the place of the PLC.
# For us: give such an array one dimension in the PLC, or write each of its elements, as MAIN.poses[1,2].
#
# Exit code 0: still so. Needs node and npm; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund ads-client@2.1.0 > install.log 2>&1 || { cat install.log; exit 1; }
cat > matrix.js <<'JS'
const assert = require('assert');
const net = require('net');
const { Client } = require('ads-client');

const [REAL64, DATA_TYPE] = [5, 1];
const memory = Buffer.alloc(1024);
const writes = [];

const number = (size, ...values) => Buffer.concat(values.map((value) => {
  const bytes = Buffer.alloc(size);
  bytes.writeUIntLE(value, 0, size);
  return bytes;
}));
const text = (...words) => Buffer.from(words.map((word) => `${word}\0`).join(''));
const entry = (...parts) => {
  const body = Buffer.concat(parts);
  return Buffer.concat([number(4, body.length + 4), body]);
};
const symbol = (name, type, offset, size) => entry(
  number(4, 0x4040, offset, size, REAL64), number(2, 0, 0, name.length, type.length, 0), text(name, type, ''));
const dataType = (name, type, size, dimensions) => entry(
  number(4, 1, 0, 0, size, 0, REAL64, DATA_TYPE),
  number(2, name.length, type.length, 0, dimensions.length, 0), text(name, type, ''),
  ...dimensions.map((length) => number(4, 0, length)));

const POSES = 'ARRAY [0..2,0..3] OF LREAL';
const LINE = 'ARRAY [0..11] OF LREAL';
const known = {
  'MAIN.poses': symbol('MAIN.poses', POSES, 0, 96),
  'MAIN.line': symbol('MAIN.line', LINE, 0, 96),
  'MAIN.speed': symbol('MAIN.speed', 'LREAL', 96, 8),
  [POSES]: dataType(POSES, 'LREAL', 96, [3, 4]),
  [LINE]: dataType(LINE, 'LREAL', 96, [12]),
  LREAL: dataType('LREAL', '', 8, []),
};

// A PLC: it gives its symbols and types, and reads and writes its memory where and as long as it is told to.
const answer = (command, data) => {
  const [group, offset, length] = [0, 4, 8].map((k) => data.readUInt32LE(k));
  if (command === 9) {
    const found = known[data.toString('latin1', 16).replace(/\0.*$/, '')];
    return found ? Buffer.concat([number(4, 0, found.length), found]) : number(4, 0x710, 0);
  }
  assert.strictEqual(group, 0x4040);
  if (command === 2) return Buffer.concat([number(4, 0, length), memory.subarray(offset, offset + length)]);
  assert.strictEqual(command, 3);
  writes.push(length);
  data.copy(memory, offset, 12);
  return number(4, 0);
};
const plc = net.createServer((socket) => {
  let received = Buffer.alloc(0);
  socket.on('data', (chunk) => {
    received = Buffer.concat([received, chunk]);
    while (received.length >= 6 && received.length >= 6 + received.readUInt32LE(2)) {
      const packet = received.subarray(6, 6 + received.readUInt32LE(2));
      received = received.subarray(6 + packet.length);
      const data = answer(packet.readUInt16LE(16), packet.subarray(32));
      socket.write(Buffer.concat([
        number(2, 0), number(4, 32 + data.length), packet.subarray(8, 16), packet.subarray(0, 8),
        packet.subarray(16, 18), number(2, 5), number(4, data.length, 0), packet.subarray(28, 32), data]));
    }
  });
});

plc.listen(0, '127.0.0.1', async () => {
  const client = new Client({
    targetAmsNetId: '10.0.0.2.1.1', targetAdsPort: 851, localAmsNetId: '10.0.0.1.1.1', localAdsPort: 32000,
    routerAddress: '127.0.0.1', routerTcpPort: plc.address().port, rawClient: true,
  });
  await client.connect();
  const rows = [[0, 1, 2, 3], [4, 5, 6, 7], [8, 9, 10, 11]];
  const found = {};
  for (const [name, value] of [['MAIN.line', rows.flat()], ['MAIN.poses', rows]]) {
    await client.writeValue('MAIN.speed', 2.5);
    await client.writeValue(name, value);
    assert.deepStrictEqual((await client.readValue(name)).value, value);
    found[name] = [writes.at(-1), (await client.readValue('MAIN.speed')).value];
  }
  console.log('Bytes that are written, and the speed behind them, which was 2.5:', found);
  assert.deepStrictEqual(found, { 'MAIN.line': [96, 2.5], 'MAIN.poses': [768, 0] });
  process.exit(0);
});
JS
timeout 60 node matrix.js

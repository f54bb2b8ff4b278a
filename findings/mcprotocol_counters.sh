#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mcprotocol 0.1.2 (npm): beside the encoder of counter C251 of an FX3U, that of C253 is read from C252.
#
# The counters of FX3 PLCs from C200 on have 32 bits, and C251 to C255 count encoders with two tracks. The readme has
# CN220 as such a count, and says that items close to each other are read in one request. Expected of addItems(['CN251',
# 'CN253']) and readAllItems(): what each of the two gives when it is read alone, -100000 and 7500 counts.
# What happens: CN251 is right and CN253 is 0, the count of C252, and no item is bad. In one request, the package looks
# for a counter two bytes further for each number, but each has four. So C236, with 300 counts, is read beside C235 as
# 19726334, from a half of each. An array (CN251,3), counters alone, and C0 to C199 are right.
# A server on this machine answers as the FX3U-ENET-ADP does by its manual (chapter 7.5: 32 counters are 64 words).
# For us: read the counters as one array, or let the PLC's program move them to D (DDINT).
#
# Exit code 0: still so. Needs node and npm; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund mcprotocol@0.1.2 > install.log 2>&1 || { cat install.log; exit 1; }
cat > counters.js <<'JS'
const assert = require('assert');
const net = require('net');
const MCProtocol = require('mcprotocol');

const print = console.log;
console.log = () => {}; // The package logs its connection there.

/** Answer the request for words (01) of counters (CN) with 32 bits, of two words each. */
function answer(request, counts) {
  const [first, words] = [request.readUInt32LE(4), request[10]];
  assert.deepStrictEqual([request[0], request.readUInt16LE(8)], [1, 0x434E]);
  const reply = Buffer.alloc(2 + 2 * words);
  reply[0] = 0x81;
  for (let place = 0; place < words / 2; place += 1) reply.writeInt32LE(counts[first + place] ?? 0, 2 + 4 * place);
  return reply;
}

function read(items, counts) {
  return new Promise((resolve, reject) => {
    const plc = net.createServer((socket) => socket.on('data', (request) => socket.write(answer(request, counts))));
    plc.listen(0, '127.0.0.1', () => {
      const client = new MCProtocol();
      client.initiateConnection({ port: plc.address().port, host: '127.0.0.1' }, (error) => {
        if (error) { reject(error); return; }
        client.addItems(items);
        client.readAllItems((bad, values) => {
          client.dropConnection();
          plc.close();
          print(items.join(' and '), '->', values, bad ? 'bad' : 'good');
          resolve({ bad, ...values });
        });
      });
    });
  });
}

(async () => {
  const encoders = { 251: -100000, 253: 7500 };
  assert.deepStrictEqual(await read(['CN251'], encoders), { bad: false, CN251: -100000 });
  assert.deepStrictEqual(await read(['CN253'], encoders), { bad: false, CN253: 7500 });
  assert.deepStrictEqual(await read(['CN251,3'], encoders), { bad: false, 'CN251,3': [-100000, 0, 7500] });
  assert.deepStrictEqual(await read(['CN251', 'CN253'], encoders), { bad: false, CN251: -100000, CN253: 0 });
  const next = { 235: -100000, 236: 300 };
  assert.deepStrictEqual(await read(['CN235', 'CN236'], next), { bad: false, CN235: -100000, CN236: 19726334 });
  process.exit(0);
})();
JS
timeout 60 node --no-deprecation counters.js

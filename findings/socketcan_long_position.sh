#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# socketcan 4.3.1 (npm): a position of -5 counts in 40 bits is read as 250 and sent as 4294967291, and 2^32 + 7 is 8.
#
# A .kcd gives a drive's position as a signed signal of 40 bits, and another's as one of 64 bits. Expected: the counts
# that were sent. What happens: DatabaseService puts a value together as low + (high << 32), which JavaScript takes as
# low + high, and for sending it sets the high word to 0 where the value is negative. Signals of up to 32 bits and
# floats are right. An object takes the place of the CAN channel.
# For us: read positions of more than 32 bits from the bytes of the frame, with readIntLE(0, 5) or readBigInt64LE().
#
# Exit code 0: still so. Needs node, npm and a C++ compiler; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund socketcan@4.3.1 > install.log 2>&1 || { cat install.log; exit 1; }
cat > drive.kcd <<'KCD'
<?xml version="1.0"?>
<NetworkDefinition xmlns="http://kayak.2codeornot2code.org/1.0">
  <Document/>
  <Bus name="joints">
    <Message id="0x100" name="Short" length="8">
      <Signal name="Position" offset="0" length="32"><Value type="signed"/></Signal>
    </Message>
    <Message id="0x101" name="Middle" length="8">
      <Signal name="Position" offset="0" length="40"><Value type="signed"/></Signal>
    </Message>
    <Message id="0x102" name="Long" length="8">
      <Signal name="Position" offset="0" length="64"><Value type="signed"/></Signal>
    </Message>
  </Bus>
</NetworkDefinition>
KCD
cat > drive.js <<'JS'
const assert = require('assert');
const can = require('socketcan');

let receive;
let sent;
const channel = {
  addListener: (event, listener, service) => { receive = listener.bind(service); },
  send: (message) => { sent = message.data; },
};
const network = can.parseNetworkDescription('drive.kcd');
const service = new can.DatabaseService(channel, network.buses.joints);
const decoded = { Short: (data) => data.readInt32LE(), Middle: (data) => data.readIntLE(0, 5),
  Long: (data) => Number(data.readBigInt64LE()) };

function through(name, counts) {
  const message = service.messages[name];
  const data = Buffer.alloc(8);
  data.writeBigInt64LE(BigInt(counts));
  receive({ id: message.id, ext: false, rtr: false, data });
  const read = message.signals.Position.value;
  message.signals.Position.update(counts);
  service.send(name);
  return [read, decoded[name](sent)];
}

const found = ['Short', 'Middle', 'Long'].map((name) => [5, -5].map((counts) => through(name, counts)));
const large = through('Middle', 2 ** 32 + 7);
console.log('5 and -5 counts, read and sent in 32, 40 and 64 bits:', JSON.stringify(found));
console.log('2^32 + 7 counts in 40 bits:', large);
assert.deepStrictEqual(found, [
  [[5, 5], [-5, -5]], [[5, 5], [250, 4294967291]], [[5, 5], [-6, 4294967291]],
]);
assert.deepStrictEqual(large, [8, 4294967303]);
JS
timeout 60 node drive.js

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# canopen 6.2.1 (npm): a position in a TPDO of type 255 is never sent, and 0.29 in steps of 0.01 is sent as 0.28.
#
# Expected: as CiA 301 has it, the transmission types 254 and 255 are both event-driven, and a TPDO with a SYNC start
# value of 1 is sent from the SYNC with the counter 1 on. What happens: a simulated drive sends nothing for type 255,
# which many EDS files of drives have, nor with a start value, because the counter is looked for in the second byte of
# a SYNC, which has one. A value with a scaleFactor is divided and then cut off instead of rounded: so 125 of the
# thousand values from 0.00 to 9.99 are read back by 0.01 less. A stub takes the place of the native CRC, which is not
# needed here.
# For us: set type 254 and no start value, and write raw counts.
#
# Exit code 0: still so. Needs node and npm; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund --ignore-scripts canopen@6.2.1
rm -r node_modules/node-crc
mkdir node_modules/node-crc
echo 'module.exports = { crc: () => Buffer.alloc(2) };' > node_modules/node-crc/index.js
cat > drive.js <<'JS'
const assert = require('assert');
const { Device, Eds } = require('canopen');

function sent(communication) {
  const eds = new Eds();
  eds.addEntry(0x1005, {
    parameterName: 'COB-ID SYNC', dataType: 'UNSIGNED32', accessType: 'rw', defaultValue: 0x80,
  });
  eds.addEntry(0x6064, {
    parameterName: 'Position actual value', dataType: 'INTEGER32', accessType: 'ro', pdoMapping: true,
  });
  const position = eds.getEntry(0x6064);
  eds.addTransmitPdo({ cobId: 0x181, dataObjects: [position], ...communication });
  const drive = new Device({ eds, id: 1 });
  const positions = [];
  drive.on('message', ({ id, data }) => {
    if (id === 0x181) positions.push(data.readInt32LE());
  });
  drive.start();
  drive.nmt.startNode();
  drive.receive({ id: 0, data: Buffer.from([1, 1]) });
  for (let count = 1; count <= 4; count++) {
    position.value = count;
    drive.receive({ id: 0x80, data: Buffer.from([count]) });
  }
  drive.stop();
  return positions;
}

const found = [{ transmissionType: 254 }, { transmissionType: 255 }, { transmissionType: 1 },
  { transmissionType: 1, syncStart: 1 }].map((communication) => [communication, sent(communication)]);
console.log(found);
assert.deepStrictEqual(found.map(([, positions]) => positions), [[1, 2, 3, 4], [], [1, 2, 3, 4], []]);

const eds = new Eds();
eds.addEntry(0x2000, { parameterName: 'Speed', dataType: 'INTEGER32', accessType: 'rw', scaleFactor: 0.01 });
const speed = eds.getEntry(0x2000);
speed.value = 0.29;
const counts = speed.raw.readInt32LE();
let wrong = 0;
for (let count = 0; count < 1000; count++) {
  speed.value = count / 100;
  if (speed.raw.readInt32LE() !== count) wrong += 1;
}
console.log('0.29 is sent as', counts, 'hundredths; wrong', wrong, 'of 1000');
assert.deepStrictEqual([counts, wrong], [28, 125]);
JS
timeout 60 node drive.js

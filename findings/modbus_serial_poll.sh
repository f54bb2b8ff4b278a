#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# modbus-serial 8.0.25 (npm): the flags 0, 5 and 9 of a drive are read from the coils 0, 1 and 2.
#
# poll() of a client takes a map of addresses and gives a value for each. Expected of the coils 5 and 9, which are set:
# true, as readCoils() gives them. What happens: registers are put into one request only if they follow each other, but
# coils and discrete inputs always. Three coils are asked for as three from the first one on, and their values are given
# under the addresses of the map: 5 and 9 are false, and coil 1 is what is called 5. Nothing tells so. Registers at 0, 5
# and 9 are right. The server of the package itself takes the place of the drive.
# For us: give each address that does not follow the one before to a poll() of its own, or use readCoils().
#
# Exit code 0: still so. Needs node and npm; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund modbus-serial@8.0.25 > install.log 2>&1 || { cat install.log; exit 1; }
cat > poll.js <<'JS'
const assert = require('assert');
const Modbus = require('modbus-serial');

const asked = [];
const isSet = (address) => address === 5 || address === 9;
const server = new Modbus.ServerTCP({
  getCoil: (address) => {
    asked.push(address);
    return isSet(address);
  },
  getDiscreteInput: isSet,
  getHoldingRegister: (address) => 100 + address,
}, { host: '127.0.0.1', port: 0, unitID: 1 });

server.on('initialized', async () => {
  const client = new Modbus();
  await client.connectTCP('127.0.0.1', { port: server._server.address().port });
  client.setID(1);
  const address = [0, 5, 9];
  const found = {};
  for (const [name, fc] of [['coils', 1], ['discrete inputs', 2], ['registers', 3]]) {
    const { data, error } = await client.poll({ unit: 1, map: [{ fc, address }] });
    assert.strictEqual(error, null);
    assert.deepStrictEqual(data.map((item) => item.address), address);
    found[name] = data.map((item) => item.value);
  }
  console.log('At 0, 5 and 9:', found, 'by asking for the coils', asked);
  assert.deepStrictEqual(found, {
    coils: [false, false, false], 'discrete inputs': [false, false, false], registers: [100, 105, 109],
  });
  assert.deepStrictEqual(asked, [0, 1, 2]);
  const single = (await client.readCoils(5, 1)).data[0];
  console.log('Coil 5 by readCoils():', single);
  assert.strictEqual(single, true);
  client.close(() => server.close(() => process.exit(0)));
});
JS
timeout 60 node poll.js

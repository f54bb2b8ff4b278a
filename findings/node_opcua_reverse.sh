#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# node-opcua-aggregates 2.186.4 (npm): the history of a shaft from 8 s back to 0 s is empty, without an error.
#
# A shaft is at t^2 rad at each second from 0 to 10 s. By OPC UA part 13, a query whose end is before its start gives
# the intervals in reverse order, the later first, and each interval excludes its end. Expected of the maximum from 8 s
# back to 0 s in steps of 2 s: four values. What happens: an empty list and no error, as the intervals are counted up
# from the start as long as they are before the end; the minimum, the average and the interpolated values likewise.
# Expected of the maximum from 1 to 8 s in steps of 3 s: 49 rad in the last interval, from 7 s to the end at 8 s. What
# happens: 64 rad, the value at 8 s, as an interval that the end cuts off includes its end.
# Output: maximum, 0 to 8 s: 1 9 25 49; 8 to 0 s: nothing
#         minimum, 0 to 8 s: 0 4 16 36; 8 to 0 s: nothing
#         average, 0 to 8 s: 0.5 6.5 20.5 42.5; 8 to 0 s: nothing
#         interpolated, 0 to 8 s: 0 4 16 36; 8 to 0 s: nothing
#         maximum, 1 to 8 s by 3 s: 9 36 64
# For us: ask for the history forwards, in a whole number of intervals, and turn the answer around yourself.
#
# Exit code 0: still so. Needs node and npm; installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund --ignore-scripts node-opcua-aggregates@2.186.4 \
    node-opcua-address-space@2.186.4 node-opcua-nodesets@2.185.0 node-opcua-data-value@2.186.4
cat > reverse.js <<'JS'
const assert = require('assert');
const { AddressSpace } = require('node-opcua-address-space');
const { generateAddressSpace } = require('node-opcua-address-space/nodeJS');
const aggregates = require('node-opcua-aggregates');
const { nodesets } = require('node-opcua-nodesets');

const BEGIN = 1700000000000;
const at = (seconds) => new Date(BEGIN + 1000 * seconds);

async function main() {
  const space = AddressSpace.create();
  await generateAddressSpace(space, [nodesets.standard]);
  aggregates.addAggregateSupport(space);
  const shaft = space.registerNamespace('urn:shaft').addVariable({
    browseName: 'angle', dataType: 'Double', organizedBy: space.rootFolder.objects,
  });
  space.installHistoricalDataNode(shaft);
  aggregates.installAggregateConfigurationOptions(shaft, {});
  for (let time = 0; time <= 10; time += 1) {
    shaft.setValueFromSource({ dataType: 'Double', value: time * time }, undefined, at(time));
  }
  const query = (read, from, to, step) => new Promise((resolve, reject) => {
    read(shaft, 1000 * step, at(from), at(to), (error, values) => {
      if (error) reject(error);
      else resolve(values.map(({ value }) => value.value).join(' '));
    });
  });
  for (const [name, read, expected] of [
    ['maximum', aggregates.getMaxData, '1 9 25 49'],
    ['minimum', aggregates.getMinData, '0 4 16 36'],
    ['average', aggregates.getAverageData, '0.5 6.5 20.5 42.5'],
    ['interpolated', aggregates.getInterpolatedData, '0 4 16 36'],
  ]) {
    const [forwards, back] = [await query(read, 0, 8, 2), await query(read, 8, 0, 2)];
    console.log(`${name}, 0 to 8 s: ${forwards}; 8 to 0 s: ${back || 'nothing'}`);
    assert.deepStrictEqual([forwards, back], [expected, '']);
  }
  const cut = await query(aggregates.getMaxData, 1, 8, 3);
  console.log(`maximum, 1 to 8 s by 3 s: ${cut}`);
  assert.strictEqual(cut, '9 36 64');
  space.dispose();
}

main().catch((error) => {
  console.error(error);
  process.exit(1);
});
JS
timeout 100 node reverse.js

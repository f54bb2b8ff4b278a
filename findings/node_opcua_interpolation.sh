#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# node-opcua-aggregates 2.186.4 (npm): the interpolated history of a shaft depends on where the query begins and ends.
#
# A shaft turns evenly with 1 rad/s, and its historian has its angle at 0, 4 and 10 s, as a deadband leaves them.
# Expected of getInterpolatedData() in steps of 1 s, as OPC UA part 13 has it: each value lies on the line between the
# values before and after it, whether they are inside of the query or not, so that at t seconds it is t rad. What
# happens: only the values within the query are read. From 0 to 12 s all is right. From 0 to 9 s the shaft stands at 4
# rad from 4 s on, marked as uncertain; from 1 to 9 s there is no data but at 4 s. Queries that follow one another
# therefore join to a wrong movement.
# For us: begin and end a query at samples that were stored, or read the raw history and interpolate it yourself.
#
# Exit code 0: still so. Needs node and npm; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund --ignore-scripts node-opcua-aggregates@2.186.4 \
    node-opcua-address-space@2.186.4 node-opcua-nodesets@2.185.0 node-opcua-data-value@2.186.4
cat > history.js <<'JS'
const assert = require('assert');
const { AddressSpace } = require('node-opcua-address-space');
const { generateAddressSpace } = require('node-opcua-address-space/nodeJS');
const aggregates = require('node-opcua-aggregates');
const { DataValue } = require('node-opcua-data-value');
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
  for (const time of [0, 4, 10]) {
    shaft.setValueFromSource({ dataType: 'Double', value: time }, undefined, at(time));
  }
  const query = (from, to) => new Promise((resolve, reject) => {
    aggregates.getInterpolatedData(shaft, 1000, at(from), at(to), (error, values) => (error ? reject(error) : resolve(values)));
  });
  const found = {};
  for (const [from, to] of [[0, 12], [0, 9], [1, 9]]) {
    const values = await query(from, to);
    found[`${from} to ${to}`] = values.map(({ statusCode, value }) => {
      if (statusCode.isBad()) return statusCode.name.split('#')[0];
      return Math.round(value.value * 1e6) / 1e6 + (statusCode.isGoodish() ? '' : '?');
    }).join(' ');
  }
  space.dispose();
  console.log(found);
  assert.deepStrictEqual(found, {
    '0 to 12': '0 1 2 3 4 5 6 7 8 9 10 10?',
    '0 to 9': '0 1 2 3 4 4? 4? 4? 4?',
    '1 to 9': 'BadNoData BadNoData BadNoData 4 BadNoData BadNoData BadNoData BadNoData',
  });
}

main().catch((error) => {
  console.error(error);
  process.exit(1);
});
JS
timeout 100 node history.js

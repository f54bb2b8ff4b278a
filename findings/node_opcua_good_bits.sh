#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# node-opcua-aggregates 2.186.4 (npm): a good value with a bit of information is left out of maximum and average.
#
# A torque has the history 10, 20, 90, 20, 10 at 0, 2, 4, 6 and 8 s. All of it is good. The status of the 90 also says
# that it is at the upper limit (Good with the bit LimitHigh); in a second run, that a queue has overflowed before it,
# as a subscription of node-opcua marks the value after lost ones (GoodWithOverflowBit).
# Expected, as OPC UA part 13 has it for good values and as with the plain status: maximum 90, average 30, and 100 % of
# each time good. What happens: the maximum is 20 and the average 15, with a status "uncertain" as if there were a bad
# value, while the count is 5 and the whole time is 100 % good. Of the 4 s that begin with the 90, which are all good,
# 50 % are given as good and 50 % as bad. So the peak is left out just where the drive was at its limit.
# For us: read the raw history and take each value whose severity is good (isGoodish() of its status), not isGood().
#
# Exit code 0: still so. Needs node and npm; installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund --ignore-scripts node-opcua-aggregates@2.186.4 \
    node-opcua-address-space@2.186.4 node-opcua-nodesets@2.185.0 node-opcua-status-code@2.186.1
cat > torque.js <<'JS'
const assert = require('assert');
const { AddressSpace } = require('node-opcua-address-space');
const { generateAddressSpace } = require('node-opcua-address-space/nodeJS');
const aggregates = require('node-opcua-aggregates');
const { StatusCode, StatusCodes } = require('node-opcua-status-code');
const { nodesets } = require('node-opcua-nodesets');

const BEGIN = 1700000000000;
const at = (seconds) => new Date(BEGIN + 1000 * seconds);

async function main() {
  const space = AddressSpace.create();
  await generateAddressSpace(space, [nodesets.standard]);
  aggregates.addAggregateSupport(space);
  const namespace = space.registerNamespace('urn:torque');
  const found = {};
  const statuses = {
    plain: StatusCodes.Good,
    limit: StatusCode.makeStatusCode(StatusCodes.Good, 'LimitHigh'),
    overflow: StatusCodes.GoodWithOverflowBit,
  };
  for (const [name, status] of Object.entries(statuses)) {
    assert(status.isGoodish() && !status.isBad());
    const torque = namespace.addVariable({
      browseName: name, dataType: 'Double', organizedBy: space.rootFolder.objects,
    });
    space.installHistoricalDataNode(torque);
    aggregates.installAggregateConfigurationOptions(torque, {});
    for (const [time, value] of [[0, 10], [2, 20], [4, 90], [6, 20], [8, 10], [10, 10]]) {
      torque.setValueFromSource({ dataType: 'Double', value }, value === 90 ? status : StatusCodes.Good, at(time));
    }
    const query = (read, from, to) => new Promise((resolve, reject) => {
      read(torque, 1000 * (to - from), at(from), at(to), (error, [result]) => {
        if (error) reject(error);
        else resolve(result.value.value + (result.statusCode.name.startsWith('Uncertain') ? '?' : ''));
      });
    });
    found[name] = [
      'count', await query(aggregates.getCountData, 0, 10),
      'maximum', await query(aggregates.getMaxData, 0, 10),
      'average', await query(aggregates.getAverageData, 0, 10),
      'good', await query(aggregates.getPercentGoodData, 0, 10),
      'from 4 to 8 s: good', await query(aggregates.getPercentGoodData, 4, 8),
      'bad', await query(aggregates.getPercentBadData, 4, 8),
    ].join(' ');
  }
  space.dispose();
  console.log(found);
  const wrong = 'count 5 maximum 20? average 15? good 100 from 4 to 8 s: good 50 bad 50';
  assert.deepStrictEqual(found, {
    plain: 'count 5 maximum 90 average 30 good 100 from 4 to 8 s: good 100 bad 0',
    limit: wrong,
    overflow: wrong,
  });
}

main().catch((error) => {
  console.error(error);
  process.exit(1);
});
JS
timeout 100 node torque.js

#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# sparkplug-payload 1.0.3 (npm): in a DataSet of Sparkplug B, an encoder at -5 counts is read at 18446744073709551611.
#
# A device sends a table of counts and angles as a DataSet, with counts of the type Int64. Expected of decodePayload():
# -5, as for the same value in a metric, in a property and in a parameter of a template. What happens: of a DataSet the
# number is taken as it stands in the message, without a sign. Counts of the types Int8 to Int32, UInt8, UInt16 and
# UInt64, which encodePayload() of the same library writes into a DataSet, are refused, with the whole message.
# Output: Int64 -5: metric -5, property -5, parameter -5, DataSet 18446744073709551611
#         types of a DataSet that are refused: Int8 Int16 Int32 UInt8 UInt16 UInt64
# For us: give such a table Double counts, and take a Long of a DataSet by `toSigned()`.
#
# Exit code 0: still so. Needs node and npm; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund sparkplug-payload@1.0.3 > install.log 2>&1 || { cat install.log; exit 1; }
cat > table.js <<'JS'
const assert = require('assert');
const sparkplug = require('sparkplug-payload').get('spBv1.0');

const STAMP = 1_700_000_000_000;

const sent = (metric) => {
  const message = { timestamp: STAMP, seq: 0, metrics: [{ name: 'encoder', timestamp: STAMP, ...metric }] };
  return sparkplug.decodePayload(sparkplug.encodePayload(message)).metrics[0];
};
const table = (type, count) => sent({
  type: 'DataSet',
  value: { numOfColumns: 2, columns: ['count', 'angle'], types: [type, 'Double'], rows: [[count, -1.5]] },
}).value.rows[0];
const template = (parameters) => ({ isDefinition: false, templateRef: 'axis', metrics: [], parameters });

const [type, value] = ['Int64', -5];
const found = {
  metric: sent({ type, value }).value,
  property: sent({ type: 'Int32', value: 1, properties: { low: { type, value } } }).properties.low.value,
  parameter: sent({ type: 'Template', value: template([{ name: 'low', type, value }]) }).value.parameters[0].value,
  DataSet: table(type, value)[0],
};
const shown = Object.entries(found).map(([name, count]) => `${name} ${count}`).join(', ');
console.log(`${type} ${value}: ${shown}`);
const refused = ['Int8', 'Int16', 'Int32', 'Int64', 'UInt8', 'UInt16', 'UInt32', 'UInt64'].filter((name) => {
  try {
    return table(name, 5)[0].toString() !== '5';
  } catch (error) {
    assert.match(error.message, /^Invalid DataSetValue/);
    return true;
  }
});
console.log('types of a DataSet that are refused:', refused.join(' '));
assert.strictEqual(shown, 'metric -5, property -5, parameter -5, DataSet 18446744073709551611');
assert.strictEqual(table(type, value)[1], -1.5);
assert.strictEqual(found.DataSet.toSigned().toNumber(), -5);
assert.deepStrictEqual(refused, ['Int8', 'Int16', 'Int32', 'UInt8', 'UInt16', 'UInt64']);
JS
timeout 60 node table.js

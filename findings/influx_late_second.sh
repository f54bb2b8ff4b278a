#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# influx 5.12.0 (npm): of a rotor that is logged at 2 kHz, one stamp in each second is read a second too late.
#
# query() with the precision 'u' gives each time as a Date that has two more methods for finer times, getNanoTime() and
# toNanoISOString(). Expected of 399 999 600 µs past midnight: 00:06:39.999600. What happens: the Date is rounded to the
# next millisecond, which is that of the next second, and toNanoISOString() joins its seconds with the fraction from
# before the rounding: 00:06:40.999600. So it is for each stamp in the last half millisecond of a second; getNanoTime()
# is right. toNanoDate(), which takes a stamp in nanoseconds as a text, divides it as a float:
# in the last 120 ns of a second its Date is a second late, so that a point with it that is written in ms is, too.
# A server on this machine answers as InfluxDB 1.8 does. For us: use getNanoTime(), never the ISO text or the Date.
#
# Exit code 0: still so. Needs node and npm; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund influx@5.12.0 > install.log 2>&1 || { cat install.log; exit 1; }
cat > read.js <<'JS'
const assert = require('assert');
const http = require('http');
const Influx = require('influx');

const midnight = 1795824000; // 2026-11-28T00:00:00Z
const stored = Array.from({ length: 4000 }, (_, index) => midnight * 1e6 + 399e6 + 100 + 500 * index);
let written = '';

const server = http.createServer((request, response) => {
  request.on('data', (data) => { written += data; });
  request.on('end', () => {
    if (request.url.startsWith('/write')) return response.writeHead(204).end();
    const values = stored.map((time, index) => [time, 0.001 * index]);
    response.setHeader('Content-Type', 'application/json');
    response.end(JSON.stringify({ results: [{ series: [{ name: 'rotor', columns: ['time', 'angle'], values }] }] }));
  });
});

server.listen(0, '127.0.0.1', async () => {
  const { port } = server.address();
  const database = new Influx.InfluxDB({ host: '127.0.0.1', port, database: 'log' });
  const rows = await database.query('select * from rotor', { precision: 'u' });
  const late = rows.filter((row, index) => Date.parse(row.time.toNanoISOString()) - stored[index] / 1000 > 900);
  console.log(`${late.length} of ${rows.length} stamps are late:`, late.map(({ time }) => time.toNanoISOString()));
  assert.deepStrictEqual(late.map(({ time }) => time.toNanoISOString()),
    ['2026-11-28T00:06:40.999600000Z', '2026-11-28T00:06:41.999600000Z']);
  assert.deepStrictEqual(late.map(({ time }) => time.getNanoTime()),
    ['1795824399999600000', '1795824400999600000']);

  const stamp = Influx.toNanoDate('1795823999999999900');
  console.log('100 ns before midnight:', stamp.toISOString(), stamp.toNanoISOString());
  assert.deepStrictEqual(stamp.toISOString(), '2026-11-28T00:00:00.999Z');
  await database.writePoints([{ measurement: 'rotor', fields: { angle: 1 }, timestamp: stamp }], { precision: 'ms' });
  console.log('Written in ms:', written);
  assert.deepStrictEqual(written, 'rotor angle=1 1795824000999');
  server.close();
});
JS
timeout 60 node read.js

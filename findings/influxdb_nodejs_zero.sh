#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# influxdb-nodejs 3.1.0 (npm): an angle of 0 rad is written as the letters of its name, and a queued time into 1970.
#
# field(key, value) is documented to set one field of a point. Expected of field('angle', 0): angle=0. What happens: a
# value that JavaScript takes as false is not seen, and the letters of the name become fields: 0="a", 1="n" and so on,
# without the angle. field('fault', false) does the same, and its first letter is written as the boolean f. Other values
# are right, and so is field({ angle: 0 }). time(time, precision) is documented for one point. Expected of queued
# points with their own precisions: each time in its own unit. What happens: all points of a syncWrite() are sent with
# the precision of the first, so that a stamp in ms behind one in ns is in 1970. A server on this machine takes the
# place of InfluxDB.
# For us: give fields as an object, and all times with one precision.
#
# Exit code 0: still so. Needs node and npm; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund influxdb-nodejs@3.1.0 > install.log 2>&1 || { cat install.log; exit 1; }
cat > write.js <<'JS'
const assert = require('assert');
const http = require('http');
const Client = require('influxdb-nodejs');

const sent = [];
const server = http.createServer((request, response) => {
  let body = '';
  request.on('data', (data) => { body += data; });
  request.on('end', () => {
    sent.push([request.url, ...body.split('\n')]);
    response.writeHead(204).end();
  });
});

server.listen(0, '127.0.0.1', async () => {
  const client = new Client(`http://127.0.0.1:${server.address().port}/log`);
  const point = () => client.write('rotor').time('1795824000000000100');
  await point().field('angle', 1.5).field('fault', true);
  await point().field('angle', 0);
  await point().field('fault', false);
  await point().field({ angle: 0, fault: false });
  point().field('angle', 1).queue();
  client.write('rotor').field('angle', 2).time('1795824000001', 'ms').queue();
  await client.syncWrite();
  for (const lines of sent) console.log(...lines);
  assert.deepStrictEqual(sent, [
    ['/write?db=log', 'rotor angle=1.5,fault=true 1795824000000000100'],
    ['/write?db=log', 'rotor 0="a",1="n",2="g",3="l",4="e" 1795824000000000100'],
    ['/write?db=log', 'rotor 0=f,1="a",2="u",3="l",4=t 1795824000000000100'],
    ['/write?db=log', 'rotor angle=0,fault=false 1795824000000000100'],
    ['/write?db=log', 'rotor angle=1 1795824000000000100', 'rotor angle=2 1795824000001'],
  ]);
  process.exit(0);
});
JS
timeout 60 node write.js

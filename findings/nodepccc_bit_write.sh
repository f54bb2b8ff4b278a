#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# nodepccc 0.1.17 (npm): a bit of N7:300, as the enable of a drive, is written to N7:7, and reported as written.
#
# The package reads and writes the files of SLC 500, MicroLogix and ControlLogix PLCs, words and bits of words alike
# (N7:12/1). Expected of writeItems('N7:300/0', true): bit 0 of N7:300 is set, as it is for N7:12/0. Writing N7:300 as a
# word and reading it are right.
# What happens: an element above 254 takes two bytes in a request, and the request for a bit has the number of the file
# there instead. So N7:300/0 sets bit 0 of N7:7 and B3:255/4 bit 4 of B3:3, and no item is bad.
# A PLC is simulated on this machine: by the DF1 manual (1770-6.5.16), an address above 254 is FF and two bytes. The
# masked write (AB), which that manual lacks, has the fields of its typed logical write (AA), a mask and the bits.
# For us: keep bits that a drive depends on in the elements up to 254, or write the whole word.
#
# Exit code 0: still so. Needs node and npm; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund nodepccc@0.1.17 > install.log 2>&1 || { cat install.log; exit 1; }
cat > bits.js <<'JS'
const assert = require('assert');
const net = require('net');
const NodePCCC = require('nodepccc');

const print = console.log;
console.log = () => {}; // The package logs its connection there.
const [READ, WRITE, MASKED_WRITE] = [0xA2, 0xAA, 0xAB];
const memory = {};

/** Carry out a command of PCCC and return the data of its answer: function, size, file, type, element, subelement. */
function execute(command) {
  let place = 2;
  const number = () => {
    if (command[place] !== 0xFF) return command[place++];
    place += 3;
    return command.readUInt16LE(place - 2);
  };
  const [file, , element] = [number(), number(), number(), number()];
  const word = `${file}:${element}`;
  const data = command.subarray(place);
  if (command[0] === WRITE) memory[word] = data.readUInt16LE(0);
  if (command[0] === MASKED_WRITE) {
    const [mask, bits] = [data.readUInt16LE(0), data.readUInt16LE(2)];
    memory[word] = ((memory[word] ?? 0) & ~mask) | (bits & mask);
  }
  if (command[0] !== READ) return Buffer.alloc(0);
  const answer = Buffer.alloc(command[1]);
  for (let k = 0; k < command[1] / 2; k += 1) answer.writeUInt16LE(memory[`${file}:${element + k}`] ?? 0, 2 * k);
  return answer;
}

/** EtherNet/IP: register a session, or answer the PCCC command that is within a request. */
function answer(request) {
  if (request.readUInt16LE(0) === 0x65) {
    request.writeUInt32LE(0x1234, 4);
    return request;
  }
  const requester = request.subarray(46, 53);
  const pccc = Buffer.concat([
    Buffer.from([0xCB, 0, 0, 0]), requester, Buffer.from([0x4F, 0]), request.subarray(55, 57),
    execute(request.subarray(57)),
  ]);
  const reply = Buffer.concat([request.subarray(0, 40), pccc]);
  reply.writeUInt16LE(reply.length - 24, 2);
  reply.writeUInt16LE(pccc.length, 38);
  return reply;
}

const plc = net.createServer((socket) => socket.on('data', (request) => socket.write(answer(request))));
plc.listen(0, '127.0.0.1', () => {
  const client = new NodePCCC();
  const write = (item, value) => new Promise((resolve) => client.writeItems(item, value, resolve));
  const read = () => new Promise((resolve) => client.readAllItems((bad, values) => resolve({ bad, ...values })));
  client.initiateConnection({ port: plc.address().port, host: '127.0.0.1' }, async (error) => {
    assert.strictEqual(error, undefined);
    for (const [item, value] of [['N7:12/0', true], ['N7:300', 4], ['N7:300/0', true], ['B3:255/4', true]]) {
      const bad = await write(item, value);
      print(`${item} = ${value}:`, bad ? 'bad,' : 'good,', 'words that are not 0:', { ...memory });
      assert(!bad);
    }
    assert.deepStrictEqual(memory, { '7:12': 1, '7:300': 4, '7:7': 1, '3:3': 16 });
    client.addItems(['N7:300', 'N7:7']);
    assert.deepStrictEqual(await read(), { bad: false, 'N7:300': 4, 'N7:7': 1 });
    process.exit(0);
  });
});
JS
timeout 60 node --no-deprecation bits.js

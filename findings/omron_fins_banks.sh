#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# omron-fins 0.5.0 (npm): a position in EE_100 of an Omron PLC is read from ED_100, a goal for EF_100 overwrites EE_100.
#
# In FINS, the words of the banks E0 to EF of the extended data memory have the codes A0 to AF, and those of E10 to E18
# the codes 60 to 68 (Omron's manual of FINS commands, W342; fins 1.0.5 for Python has the same codes). The bank ED is
# missing in the table of the package, and EE and EF have the codes of ED and EE, for words and for bits. Expected of
# read('EE_100'): the word 100 of this bank. What happens: that of ED, without an error, and write('EF_100', 7) changes
# EE. No address leads to EF. read('ED_100') is an error. The words of E0 to EC and of E10 to E18 are right.
# A PLC is simulated that keeps its banks apart; it tells the banks by the codes of the manual.
# For us: keep positions and goals in D or in the banks up to EC.
#
# Exit code 0: still so. Needs node and npm; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund omron-fins@0.5.0 > install.log 2>&1 || { cat install.log; exit 1; }
cat > banks.js <<'JS'
const assert = require('assert');
const dgram = require('dgram');
const fins = require('omron-fins');

const READ = 0x0101;
const banks = {};
for (let bank = 0; bank < 16; bank += 1) banks[0xA0 + bank] = 'E' + bank.toString(16).toUpperCase();
for (let bank = 0; bank < 9; bank += 1) banks[0x60 + bank] = 'E1' + bank;
// In each bank, the word 100 is 1000 and the number of the bank.
const memory = Object.fromEntries(Object.values(banks).map((bank) => [bank, 1000 + parseInt(bank.slice(1), 16)]));
const plc = dgram.createSocket('udp4');
plc.on('message', (request, sender) => {
  assert.strictEqual(request.readUInt16BE(13), 100);
  const bank = banks[request[12]];
  const reads = request.readUInt16BE(10) === READ;
  if (!reads) memory[bank] = request.readInt16BE(18);
  const answer = Buffer.alloc(reads ? 16 : 14);
  request.copy(answer, 0, 0, 12);
  answer[0] = 0xC0;
  if (reads) answer.writeInt16BE(memory[bank], 14);
  plc.send(answer, sender.port, sender.address);
});

function answered(ask) {
  return new Promise((resolve, reject) => {
    ask((error, message) => (error ? reject(error) : resolve(message.response)));
  });
}

plc.bind(0, '127.0.0.1', async () => {
  const client = fins.FinsClient(plc.address().port, '127.0.0.1', { timeout: 5000, MODE: 'CJ' });
  await new Promise((resolve) => { client.on('open', resolve); });
  const wrong = [];
  for (const bank of Object.values(banks)) {
    const word = memory[bank];
    let found;
    try {
      [found] = (await answered((back) => client.read(`${bank}_100`, 1, back))).values;
    } catch (error) {
      found = error.message;
    }
    if (found !== word) wrong.push([bank, word, found]);
  }
  await answered((back) => client.write('EF_100', [7], back));
  console.log('read wrongly, of 25 banks:', JSON.stringify(wrong));
  console.log('after write(EF_100, 7): EE has', memory.EE, 'and EF has', memory.EF);
  assert.deepStrictEqual(wrong.map(([bank, word]) => [bank, word]), [['ED', 1013], ['EE', 1014], ['EF', 1015]]);
  assert.match(wrong[0][2], /not a valid address/);
  assert.deepStrictEqual([wrong[1][2], wrong[2][2], memory.EE, memory.EF], [1013, 1014, 7, 1015]);
  process.exit(0);
});
JS
timeout 60 node banks.js

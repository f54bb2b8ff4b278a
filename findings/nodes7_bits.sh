#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# nodes7 0.3.18: writing two of the eight flags in a byte of an S7 PLC clears the other six.
#
# Expected: DB1,X0.3.2, which reads the bits 3 and 4 of the byte 0 as an array, also writes these two alone, as
# DB1,X0.3 does with one. What happens: an array of bits is written as whole bytes, whose other bits are 0: here the
# flags 1, 2, 6 and 7, which nobody named, are cleared; one of them may enable a drive or hold a brake open. Nothing
# is reported. The server of Snap7 answers here as a PLC does.
# For us: write each flag by its own name, as DB1,X0.3; several go in one `writeItems`.
#
# Exit code 0: still so. Needs node and npm; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check python-snap7==2.0.2
cd "$folder"
npm install --silent --no-audit --no-fund --prefix "$folder" nodes7@0.3.18 > /dev/null
cat > plc.py <<'PYTHON'
import ctypes
import socket
import sys

from snap7.server import Server
from snap7.type import SrvArea

with socket.create_server(('127.0.0.1', 0)) as free:
    port = free.getsockname()[1]
memory = (ctypes.c_uint8 * 8)()
memory[0] = 0b11000111
server = Server()
server.register_area(SrvArea.DB, 1, memory)
server.start(tcp_port=port)
print(port, flush=True)
sys.stdin.read()
server.stop()
PYTHON
cat > write.js <<'JS'
const assert = require('assert');
const {spawn} = require('child_process');
const nodes7 = require('nodes7');

process.exitCode = 1;

async function main() {
  const plc = spawn('venv/bin/python', ['plc.py'], {stdio: ['pipe', 'pipe', 'inherit']});
  const port = Number(await new Promise((done) => plc.stdout.once('data', done)));
  const client = new nodes7({silent: true});
  await new Promise((done, failed) => client.initiateConnection(
    {host: '127.0.0.1', port, rack: 0, slot: 1}, (error) => (error ? failed(error) : done())));
  client.addItems(['DB1,X0.0.8', 'DB1,X0.3.2']);
  const read = async () => {
    const values = await new Promise((done, failed) => client.readAllItems(
      (error, all) => (error ? failed(new Error('read')) : done(all))));
    return values['DB1,X0.0.8'].map(Number).join('') + ' ' + values['DB1,X0.3.2'].map(Number).join('');
  };
  const write = (names, values) => new Promise((done, failed) => client.writeItems(
    names, values, (error) => (error ? failed(new Error('write')) : done())));
  const seen = [await read()];
  await write(['DB1,X0.0', 'DB1,X0.4'], [false, true]);
  seen.push(await read());
  await write('DB1,X0.3.2', [true, false]);
  seen.push(await read());
  console.log('flags 0 to 7, and 3 and 4: at first, after two single ones, after the array of two:', seen);
  plc.kill();
  assert.deepStrictEqual(seen, ['11100011 00', '01101011 01', '00010000 10']);
  process.exit(0);
}

main().catch((error) => {
  console.error(error);
  process.exit(1);
});
JS
timeout 60 node write.js

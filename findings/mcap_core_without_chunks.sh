#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# @mcap/core 2.2.2 (npm): of a recording without chunks its indexed reader gives no message, and no error.
#
# A recording of a rotor is written without chunks, as `ros2 bag record --storage-preset-profile fastwrite` does; its
# summary says that it has ten messages. Expected of readMessages() of McapIndexedReader: the ten, as the reader of
# mcap 1.6.0 for Python gives them, or an error, as the recording has no index of messages. What happens: the loop
# ends at once, as for a recording in which nothing was published, while statistics.messageCount is 10. With chunks the
# ten are read, and without them McapStreamReader of the same package gives them.
# For us: where chunkIndexes is empty and statistics.messageCount is not 0, read by McapStreamReader.
#
# Exit code 0: still so. Needs node; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund --ignore-scripts @mcap/core@2.2.2
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check mcap==1.6.0
cat > read.mjs <<'JS'
import assert from 'node:assert';
import fs from 'node:fs';
import { McapIndexedReader, McapStreamReader, McapWriter, TempBuffer } from '@mcap/core';

async function recorded(useChunks) {
  const file = new TempBuffer();
  const writer = new McapWriter({ writable: file, useChunks });
  await writer.start({ profile: '', library: '' });
  const data = new TextEncoder().encode('{"angle": 1.5}');
  const schema = { name: 'Rotor', encoding: 'jsonschema', data: new TextEncoder().encode('{}') };
  const channel = { topic: '/rotor', messageEncoding: 'json', metadata: new Map() };
  const schemaId = await writer.registerSchema(schema);
  const channelId = await writer.registerChannel({ ...channel, schemaId });
  for (let sequence = 0; sequence < 10; sequence++) {
    const time = BigInt(sequence) * 10_000_000n;
    await writer.addMessage({ channelId, sequence, logTime: time, publishTime: time, data });
  }
  await writer.end();
  return file.get();
}

async function read(bytes) {
  const reader = await McapIndexedReader.Initialize({ readable: new TempBuffer(bytes) });
  let indexed = 0;
  for await (const message of reader.readMessages()) indexed += message.data.length > 0;
  const stream = new McapStreamReader();
  stream.append(bytes);
  let streamed = 0;
  for (let record; (record = stream.nextRecord()); ) streamed += record.type === 'Message';
  return { stated: Number(reader.statistics.messageCount), chunks: reader.chunkIndexes.length, indexed, streamed };
}

for (const useChunks of [true, false]) {
  const bytes = await recorded(useChunks);
  const found = await read(bytes);
  console.log('with chunks:', useChunks, found);
  assert.deepEqual(found, { stated: 10, chunks: Number(useChunks), indexed: useChunks ? 10 : 0, streamed: 10 });
  fs.writeFileSync(`${useChunks ? 'with' : 'without'}.mcap`, bytes);
}
JS
timeout 60 node read.mjs
timeout 60 venv/bin/python - <<'PYTHON'
from mcap.reader import make_reader

for name in ('with.mcap', 'without.mcap'):
    with open(name, 'rb') as file:
        count = len(list(make_reader(file).iter_messages()))
    print('Messages by Python:', count)
    assert count == 10
PYTHON

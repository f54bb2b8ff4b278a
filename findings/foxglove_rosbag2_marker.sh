#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# @foxglove/rosbag2 5.0.1, @foxglove/rosbag2-web 4.1.1 (npm): the text of a marker since ROS 2 Humble is read as empty,
# and a topic that begins in the second file of a recording is not listed.
#
# A recording of ROS 2 Jazzy in two .db3 files: a marker with the text "19.0 turns" in the first, and an output that
# begins in the second. Expected: the text, as rosbags 0.11.9 reads it, and two topics. What happens: each message is
# decoded by its definition in ROS 2 Galactic, where a marker has no texture, so that the text is '' without an error;
# an array of two markers is a RangeError. The definitions of Jazzy are in the package that the reader uses. And
# readTopics() takes the topics of the first file alone, although readMessages() gives the messages of both.
# For us: record mcap, which has the definitions in it.
#
# Exit code 0: still so. Needs node; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts @foxglove/rosbag2@5.0.1 @foxglove/rosbag2-web@4.1.1
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check rosbags==0.11.9 numpy==2.4.6
cat > read.mjs <<'JAVASCRIPT'
import fs from 'node:fs';
import { createRequire } from 'node:module';
globalThis.File ??= class File {};
const require = createRequire(import.meta.url);
const { Rosbag2 } = require('@foxglove/rosbag2');
const { SqliteSqljs } = require('@foxglove/rosbag2-web');
const wasm = require.resolve('@foxglove/sql.js').replace(/[^/]*$/, 'sql-wasm.wasm');
await SqliteSqljs.Initialize({ wasmBinary: fs.readFileSync(wasm) });
const bag = new Rosbag2(process.argv.slice(2).map((name) => new SqliteSqljs(new Uint8Array(fs.readFileSync(name)))));
await bag.open();
const read = { topics: (await bag.readTopics()).map((topic) => topic.name), messages: [] };
try {
  for await (const message of bag.readMessages()) {
    const { text, position } = message.value;
    read.messages.push([message.topic.name, text ?? Array.from(position ?? [])]);
  }
} catch (error) {
  read.error = error.name;
}
console.log(JSON.stringify(read));
JAVASCRIPT
timeout 120 venv/bin/python - <<'PYTHON'
import json
import subprocess
from pathlib import Path

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

store = get_typestore(Stores.ROS2_JAZZY)
types = store.types


def message(kind, /, **values):
    return types[kind](**values)


def marker(text):
    point, empty = types['geometry_msgs/msg/Point'], np.zeros(0, np.uint8)
    header = message('std_msgs/msg/Header', stamp=message('builtin_interfaces/msg/Time', sec=1, nanosec=0), frame_id='')
    texture = message('sensor_msgs/msg/CompressedImage', header=header, format='', data=empty)
    turn = message('geometry_msgs/msg/Quaternion', x=0.0, y=0.0, z=0.0, w=1.0)
    return message(
        'visualization_msgs/msg/Marker', header=header, ns='', id=0, type=9, action=0,
        pose=message('geometry_msgs/msg/Pose', position=point(0.0, 0.0, 0.0), orientation=turn),
        scale=message('geometry_msgs/msg/Vector3', x=1.0, y=1.0, z=1.0),
        color=message('std_msgs/msg/ColorRGBA', r=1.0, g=1.0, b=1.0, a=1.0),
        lifetime=message('builtin_interfaces/msg/Duration', sec=0, nanosec=0), frame_locked=False, points=[], colors=[],
        texture_resource='', texture=texture, uv_coordinates=[], text=text, mesh_resource='',
        mesh_file=message('visualization_msgs/msg/MeshFile', filename='', data=empty), mesh_use_embedded_materials=False,
    )  # fmt: skip


def recorded(folder, topic, content):
    """The .db3 of a recording with one message."""
    with Writer(Path(folder), version=9, storage_plugin=StoragePlugin.SQLITE3) as writer:
        connection = writer.add_connection(topic, content.__msgtype__, typestore=store)
        writer.write(connection, 1_000_000_000, store.serialize_cdr(content, content.__msgtype__))
    (name,) = Path(folder).glob('*.db3')
    return str(name)


def read(*names):
    found = json.loads(subprocess.run(['node', 'read.mjs', *names], check=True, stdout=subprocess.PIPE).stdout)
    print(found)
    return found


text = marker('19.0 turns')
data = store.serialize_cdr(text, text.__msgtype__)
assert store.deserialize_cdr(data, text.__msgtype__).text == '19.0 turns'
state = message(
    'sensor_msgs/msg/JointState', header=text.header, name=['output'], position=np.array([1.5]),
    velocity=np.zeros(0), effort=np.zeros(0),
)  # fmt: skip
found = read(recorded('first', '/text', text), recorded('second', '/output', state))
assert found == {'topics': ['/text'], 'messages': [['/text', ''], ['/output', [1.5]]]}
both = message('visualization_msgs/msg/MarkerArray', markers=[text, marker('20.0 turns')])
assert read(recorded('array', '/markers', both)).get('error') == 'RangeError'
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# @foxglove/omgidl-serialization 1.0.3 (npm): behind an @optional torque, a speed of 3 rad/s is read as 5.3e-315 rad/s.
#
# A DDS message of position, @optional torque and velocity, serialized by pycdr2 1.0.0, which is that of Cyclone DDS.
# In XCDR2 a byte before an optional member says whether it is there. Expected of a reader of "CDR, XCDR1 and XCDR2":
# it reads the byte. What happens in a struct that is @final or @appendable: the annotation is ignored, as the README of
# its parser says of all but a default value, and with it the byte. All members after it are read from the wrong place,
# without an error; only a message without the torque, which is shorter, ends in a RangeError. In a @mutable struct the
# torque is read right.
# @lichtblick/omgidl-serialization 1.0.0 does the same.
# For us: ROS messages have no optional members. In an IDL of your own make the struct @mutable, or write NaN instead.
#
# Exit code 0: still so. Needs node; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pycdr2==1.0.0
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts \
    @foxglove/omgidl-serialization@1.0.3 @foxglove/omgidl-parser@1.1.0 \
    @lichtblick/omgidl-serialization@1.0.0 @lichtblick/omgidl-parser@1.0.0
timeout 60 venv/bin/python - > messages.json <<'PYTHON'
import json
from dataclasses import dataclass
from typing import Optional

from pycdr2 import IdlStruct, annotations, types

messages = {}
for kind in ('final', 'appendable', 'mutable'):

    @dataclass
    @getattr(annotations, kind)
    class Reading(IdlStruct, typename='Reading'):
        position: types.float64
        torque: Optional[types.float64]
        velocity: types.float64

    written = Reading(0.25, 1.5, 3.0).serialize(use_version_2=True)
    assert Reading.deserialize(written) == Reading(0.25, 1.5, 3.0)
    messages[kind] = written.hex()
print(json.dumps(messages))
PYTHON
cat > read.cjs <<'JAVASCRIPT'
const assert = require('node:assert');
const messages = require('./messages.json');

for (const scope of ['@foxglove', '@lichtblick']) {
  const { parseIDL } = require(`${scope}/omgidl-parser`);
  const { MessageReader } = require(`${scope}/omgidl-serialization`);
  const read = {};
  for (const [kind, hex] of Object.entries(messages)) {
    const members = 'double position; @optional double torque; double velocity;';
    const reader = new MessageReader('Reading', parseIDL(`@${kind} struct Reading { ${members} };`));
    read[kind] = reader.readMessage(Buffer.from(hex, 'hex'));
  }
  console.log(scope, read);
  assert.deepEqual(read.mutable, { position: 0.25, torque: 1.5, velocity: 3 });
  for (const kind of ['final', 'appendable']) {
    assert.equal(read[kind].torque, 5e-324);
    assert.equal(read[kind].velocity.toPrecision(2), '5.3e-315');
  }
}
JAVASCRIPT
timeout 60 node read.cjs

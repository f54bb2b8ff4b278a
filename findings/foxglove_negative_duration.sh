#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# @foxglove/rostime 1.1.3, @foxglove/rosmsg2-serialization 3.1.0: a duration of -0.5 s is written as 3.79 s.
#
# ROS has no negative nanoseconds: -0.5 s are -1 s and 500000000 ns. Expected of fromSec(-0.5): that. What happens:
# fromSec() and fromMillis() give 0 s and -500000000 ns, which toSec() takes back, but the writer of messages puts into
# unsigned 32 bits: the reader gets 0 s and 3794967296 ns. Neither raises an error. subtract() has the form of ROS.
# For us: take negative durations from subtract(), or write Math.floor(x) as the seconds and the rest as the
# nanoseconds.
#
# Exit code 0: still so. Needs node; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts \
    @foxglove/rostime@1.1.3 @foxglove/rosmsg@5.0.5 @foxglove/rosmsg2-serialization@3.1.0
cat > lag.cjs <<'JAVASCRIPT'
const assert = require('node:assert');
const { parse } = require('@foxglove/rosmsg');
const { MessageReader, MessageWriter } = require('@foxglove/rosmsg2-serialization');
const { fromMillis, fromSec, subtract, toSec } = require('@foxglove/rostime');

const definition = parse(
  'builtin_interfaces/Duration lag\n===\nMSG: builtin_interfaces/Duration\nint32 sec\nuint32 nanosec\n',
  { ros2: true },
);
const writer = new MessageWriter(definition);
const reader = new MessageReader(definition, { timeType: 'sec,nsec' });
const sent = (lag) => toSec(reader.readMessage(writer.writeMessage({ lag })).lag);
const read = {
  'fromSec(0.5)': sent(fromSec(0.5)),
  'fromSec(-0.5)': sent(fromSec(-0.5)),
  'fromMillis(-20)': sent(fromMillis(-20)),
  'subtract(1 s, 1.5 s)': sent(subtract({ sec: 1, nsec: 0 }, { sec: 1, nsec: 500000000 })),
};
console.log(fromSec(-0.5), toSec(fromSec(-0.5)), read);
assert.equal(toSec(fromSec(-0.5)), -0.5);
assert.deepEqual(Object.values(read).map((lag) => lag.toFixed(9)), ['0.500000000', '3.794967296', '4.274967296', '-0.500000000']);
JAVASCRIPT
timeout 60 node lag.cjs

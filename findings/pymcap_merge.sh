#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pymcap-cli 0.34.0: merge puts recordings one behind the other, not in order of time.
#
# Two recordings of the same second, a driver's and a node's, are merged. In the file all messages of the
# first come before those of the second, so that their chunks overlap in time and the log time falls from
# 9 to 0. It exits with 0 and says nothing of it. `pymcap-cli sort` puts them in order afterwards.
# Readers that go by the index sort the messages again; those that read the file from front to back, as is
# needed without an index or from a pipe, get an order in which an output comes after all inputs.
# For us: overlapping chunks are merged by time while they are read, within a bound of memory.
#
# Exit code 0: still so. Installs pymcap-cli and mcap into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pymcap-cli==0.34.0 mcap==1.6.0
cd "$folder"
cat > write.py <<'PYTHON'
from mcap.writer import Writer

for topic in ('rotor', 'output'):
    with open(f'{topic}.mcap', 'wb') as stream:
        writer = Writer(stream)
        writer.start(profile='ros2')
        schema = writer.register_schema('std_msgs/msg/Empty', 'ros2msg', b'')
        channel = writer.register_channel(f'/{topic}', 'cdr', schema)
        for time in range(10):
            writer.add_message(channel, time, bytes(5), time)
        writer.finish()
PYTHON
cat > order.py <<'PYTHON'
import sys

from mcap.reader import make_reader

with open(sys.argv[1], 'rb') as stream:
    in_file = make_reader(stream).iter_messages(log_time_order=False)
    times = [message.log_time for _, _, message in in_file]
print(sys.argv[1], times)
expected = [*range(10)] * 2
assert times == (sorted(expected) if sys.argv[1] == 'sorted.mcap' else expected)
PYTHON
venv/bin/python write.py
venv/bin/pymcap-cli merge rotor.mcap output.mcap -o merged.mcap > merge.log 2>&1
venv/bin/python order.py merged.mcap
venv/bin/pymcap-cli sort merged.mcap -o sorted.mcap > sort.log 2>&1
venv/bin/python order.py sorted.mcap

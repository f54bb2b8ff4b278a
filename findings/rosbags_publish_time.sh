#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rosbags 0.11.9: rosbags-convert from mcap to mcap replaces the time of publishing by that of reception.
#
# Each message of the recording was published 5 ns before it was received, and is numbered. After
# `rosbags-convert` the time of publishing is that of reception, and every number is 0; attachments are
# gone. The tool exits with 0 and says nothing of it. So the latency between driver and recorder
# reads 0 in the copy, and lost messages no longer show in the numbers.
# For us: measure latencies in the original; a copy whose two times never differ may have been converted.
#
# Exit code 0: still so. Installs rosbags and mcap into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check rosbags==0.11.9 mcap==1.6.0
cd "$folder"
cat > write.py <<'PYTHON'
from mcap.writer import Writer

with open('recorded.mcap', 'wb') as stream:
    writer = Writer(stream)
    writer.start(profile='ros2')
    schema = writer.register_schema('std_msgs/msg/Bool', 'ros2msg', b'bool data')
    channel = writer.register_channel('/enabled', 'cdr', schema, {'offered_qos_profiles': '[]'})
    for number in range(1, 4):
        time = 10 * number
        writer.add_message(channel, time, b'\0\1\0\0\1', time - 5, number)
    writer.add_attachment(1, 1, 'bench.txt', 'text/plain', b'gear 3')
    writer.finish()
PYTHON
cat > times.py <<'PYTHON'
import sys
from pathlib import Path

from mcap.reader import make_reader


def content(path):
    with path.open('rb') as stream:
        reader = make_reader(stream)
        messages = [m for _, _, m in reader.iter_messages()]
        found = [(m.log_time, m.publish_time, m.sequence) for m in messages]
        return found, [each.name for each in reader.iter_attachments()]


(copy,) = Path('converted').glob('*.mcap')
print('recorded', content(Path('recorded.mcap')))
print('converted', content(copy))
assert content(Path('recorded.mcap')) == ([(10, 5, 1), (20, 15, 2), (30, 25, 3)], ['bench.txt'])
assert content(copy) == ([(10, 10, 0), (20, 20, 0), (30, 30, 0)], [])
PYTHON
venv/bin/python write.py
venv/bin/rosbags-convert --src recorded.mcap --dst converted --dst-storage mcap
venv/bin/python times.py

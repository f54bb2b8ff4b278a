#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mcap 1.6.0: with reverse=True, the first message of a recording without chunks is given as the last one.
#
# A shaft turns from 0 to 99 rad in 100 messages, and its last angle is the reference of the next recording. Expected of
# the first message that iter_messages() yields with reverse=True, which means "in descending log time order": 99 rad.
# What happens: 99 rad where the messages are in chunks. In a file without chunks, as the preset "fastwrite" of ROS 2
# makes it, and in one without a summary, reverse is not used: the messages come in ascending order, and the first of
# them has 0 rad. No error or warning says so. The bounds of the time and the topics are kept.
# For us: sort the messages by log_time, or compare the first two times.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mcap==1.6.0
timeout 60 "$folder/venv/bin/python" -W error - <<'PYTHON'
import io
import struct

from mcap.reader import SeekingReader, make_reader
from mcap.writer import IndexType, Writer

STEP = 10_000_000


def recorded(**options):
    """Return the bytes of a recording of 100 angles, 10 ms apart."""
    file = io.BytesIO()
    writer = Writer(file, chunk_size=200, **options)
    writer.start('ros2')
    schema = writer.register_schema('std_msgs/msg/Float64', 'ros2msg', b'float64 data')
    channel = writer.register_channel('/angle', 'cdr', schema)
    for number in range(100):
        data = b'\x00\x01\x00\x00' + struct.pack('<d', number)
        writer.add_message(channel, number * STEP, data, number * STEP, number)
    writer.finish()
    return file.getvalue()


def angles(recording, **choice):
    reader = make_reader(io.BytesIO(recording))
    assert isinstance(reader, SeekingReader)
    return [struct.unpack('<d', message.data[4:])[0] for _, _, message in reader.iter_messages('/angle', **choice)]


chunked = recorded()
others = {
    'without chunks': recorded(use_chunking=False),
    'without a summary': recorded(index_types=IndexType.NONE, use_statistics=False, use_summary_offsets=False,
                                  repeat_channels=False, repeat_schemas=False),
}  # fmt: skip
found = angles(chunked, reverse=True)
print('in chunks: first', found[0], 'last', found[-1])
assert found == list(range(99, -1, -1))
for name, recording in others.items():
    found = angles(recording, reverse=True)
    print(name, ': first', found[0], 'last', found[-1])
    assert found == angles(recording) == list(range(100))
    assert angles(recording, reverse=True, starting_at=5 * STEP, ending_before=9 * STEP) == [5, 6, 7, 8]
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pybag-sdk 0.13.0 and rosbag-resurrector 0.8.7: a JointState without velocities is misread.
#
# In CDR, padding comes before an element of a sequence. Both also skip it after the length of an empty
# sequence of doubles, so that they look for the next field 4 bytes too late. Of three recorded messages:
#
#                             pybag-sdk                       rosbag-resurrector
#     all fields              read                            read
#     no velocity             the effort of 3.0 is missing    the effort of 3.0 is missing
#     position alone          struct.error                    an empty row, and a line on stderr
#
# mcap-ros2-support 0.6.0 reads all of them, as ROS does. Drivers that send the position alone are common.
# For us: a table from these two that lacks efforts or rows does not mean that the driver sent none.
#
# Exit code 0: still so. Installs the packages into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    pybag-sdk==0.13.0 rosbag-resurrector==0.8.7 mcap==1.6.0 mcap-ros2-support==0.6.0
cat > "$folder/read.py" <<'PYTHON'
import struct
import sys

from mcap.reader import make_reader
from mcap.writer import Writer
from mcap_ros2.decoder import DecoderFactory
from pybag.mcap_reader import McapFileReader
from resurrector import BagFrame

DEFINITION = b"""std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""


def joint_state(*fields):
    data = struct.pack('<iII4sI', 7, 0, 1, b'', 1) + struct.pack('<I4s', 3, b'm1')
    for values in fields:
        data += struct.pack('<I', len(values))
        if values:
            data += bytes(-len(data) % 8) + struct.pack(f'<{len(values)}d', *values)
    return b'\0\1\0\0' + data


def mcap_ros2(path):
    with open(path, 'rb') as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        [(*_, message)] = reader.iter_decoded_messages()
    return [list(values) for values in (message.position, message.velocity, message.effort)]


def pybag(path):
    try:
        [message] = McapFileReader.from_file(path).messages('/joint_states')
    except struct.error as error:
        return type(error).__name__
    return [list(each) for each in (message.data.position, message.data.velocity, message.data.effort)]


def resurrector(path):
    [row] = BagFrame(path)['/joint_states'].to_pandas().to_dict('records')
    names = ('position', 'velocity', 'effort')
    return [[row[f'{name}.0']] if f'{name}.0' in row else [] for name in names]


path = sys.argv[1]
for fields, by_pybag, by_resurrector in (
    ([[1.0], [2.0], [3.0]], [[1.0], [2.0], [3.0]], [[1.0], [2.0], [3.0]]),
    ([[1.0], [], [3.0]], [[1.0], [], []], [[1.0], [], []]),
    ([[1.0], [], []], 'error', [[], [], []]),
):
    with open(path, 'wb') as stream:
        writer = Writer(stream)
        writer.start(profile='ros2')
        schema = writer.register_schema('sensor_msgs/msg/JointState', 'ros2msg', DEFINITION)
        channel = writer.register_channel('/joint_states', 'cdr', schema)
        writer.add_message(channel, 10, joint_state(*fields), 10)
        writer.finish()
    print(fields, 'mcap_ros2', mcap_ros2(path), 'pybag', pybag(path), 'resurrector', resurrector(path))
    assert mcap_ros2(path) == fields
    assert pybag(path) == by_pybag
    assert resurrector(path) == by_resurrector
PYTHON
HOME="$folder" "$folder/venv/bin/python" "$folder/read.py" "$folder/joints.mcap"

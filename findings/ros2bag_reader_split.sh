#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# ros2bag-reader 0.1.0: in a split recording of .db3 files, the messages of the output are given as those of the rotor.
#
# A rotor at 1 rad and an output at 0.05 rad, in a recording that rosbag2 has split into two files. Expected:
# automatic support of split bags, as promised. What happens: the number of a topic in the first file is used for all
# files, as "schema is identical across splits". It is not: rosbag2 registers the topics of a next file in the order
# of an unordered map, by which two topics usually exchange their numbers. So the rotor jumps from 1 to 0.05 rad where
# the file changes, and the output to 1 rad. Topics of different types end in an error, or in misread messages.
# For us: rosbags, ros2 bag convert and gearkin look the topics up in each file.
#
# The files are written by rosbags 0.11.9, one by one; rosidl_runtime_py, which is not on PyPI, is replaced by its one
# function. Exit code 0: still so. Installs the wheels into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    'ros-jazzy-rclpy[fastrtps]==7.1.6' ros-jazzy-sensor-msgs==5.3.6 rosbags==0.11.9
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps ros2bag-reader==0.1.0
mkdir "$folder/rosidl_runtime_py"
cat > "$folder/rosidl_runtime_py/utilities.py" <<'PYTHON'
from importlib import import_module


def get_message(identifier):
    package, group, name = identifier.split('/')
    return getattr(import_module(f'{package}.{group}'), name)
PYTHON
cd "$folder"
export ROS_LOG_DIR="$folder/log"
PYTHONPATH="$folder" timeout 60 venv/bin/python - <<'PYTHON'
import shutil
from pathlib import Path

import numpy as np
import yaml
from ros2bag_reader import ROS2BagReader
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

store = get_typestore(Stores.ROS2_JAZZY)
KIND = 'sensor_msgs/msg/JointState'
ANGLES = {'/motor/joint_states': 1.0, '/output_state': 0.05}


def write(name, topics, second):
    with Writer(name, version=9, storage_plugin=StoragePlugin.SQLITE3) as bag:
        for topic in topics:
            connection = bag.add_connection(topic, KIND, typestore=store)
            header = store.types['std_msgs/msg/Header'](store.types['builtin_interfaces/msg/Time'](second, 0), '')
            message = store.types[KIND](header, ['joint'], np.array([ANGLES[topic]]), np.array([]), np.array([]))
            bag.write(connection, second * 10**9, store.serialize_cdr(message, KIND))


write('recording', list(ANGLES), 1)
write('next', list(ANGLES)[::-1], 2)
shutil.move('next/next.db3', 'recording/recording_1.db3')
path = Path('recording/metadata.yaml')
metadata = yaml.safe_load(path.read_text())
information = metadata['rosbag2_bagfile_information']
first = information['files'][0]
second = dict(first, path='recording_1.db3', starting_time={'nanoseconds_since_epoch': 2 * 10**9})
information.update(files=[first, second], relative_file_paths=[first['path'], second['path']])
information.update(message_count=4, duration={'nanoseconds': 10**9})
for topic in information['topics_with_message_count']:
    topic['message_count'] = 2
path.write_text(yaml.safe_dump(metadata))

reader = ROS2BagReader('recording')
read = {topic: reader.get_field_array(topic, ['position[0]']).ravel().tolist() for topic in ANGLES}
right = {topic: [] for topic in ANGLES}
with AnyReader([Path('recording')]) as bag:
    for connection, _, data in bag.messages():
        right[connection.topic].append(bag.deserialize(data, KIND).position[0])
print('ros2bag-reader', read)
print('rosbags', right)
assert right == {topic: [angle, angle] for topic, angle in ANGLES.items()}
assert read == {'/motor/joint_states': [1.0, 0.05], '/output_state': [0.05, 1.0]}
PYTHON

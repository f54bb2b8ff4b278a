#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# ros2bag-repairer 0.1.0: a repaired recording of twelve files is read in the order 0, 1, 10, 11, 2, so that the motor
# jumps back.
#
# `ros2 bag record` numbers its files from motor_0.db3 on. A recorder that is ended before it has written metadata.yaml
# leaves the files alone, and this tool makes the missing file. Expected: its files are in the order of their numbers,
# which is that of their times. What happens: they are in the order of the alphabet. A reader goes through them as they
# are listed, as rosbags does here with twelve files of a second each: the third second of a motor at 1 rad/s is the
# eleventh, and after the twelfth the time goes back by 10 s. The number of messages, their first and their last time in
# metadata.yaml are right.
# For us: sort `files` and `relative_file_paths` in metadata.yaml by number, or use `ros2 bag reindex`.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check ros2bag-repairer==0.1.0 rosbags==0.11.9
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
from pathlib import Path

import numpy as np
import yaml
from ros2bag_repairer import repair
from rosbags.rosbag2 import Reader, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

START = 1795838400
store = get_typestore(Stores.ROS2_JAZZY)
kind = 'sensor_msgs/msg/JointState'
Path('motor').mkdir()
for part in range(12):
    with Writer(f'part{part}', version=9, storage_plugin=StoragePlugin.SQLITE3) as bag:
        topic = bag.add_connection('/joint_states', kind, typestore=store)
        for tenth in range(10 * part, 10 * part + 10):
            stamp = store.types['builtin_interfaces/msg/Time'](START + tenth // 10, tenth % 10 * 10**8)
            header = store.types['std_msgs/msg/Header'](stamp, '')
            message = store.types[kind](header, ['motor'], np.array([tenth / 10]), np.array([]), np.array([]))
            bag.write(topic, START * 10**9 + tenth * 10**8, store.serialize_cdr(message, kind))
    Path(f'part{part}/part{part}.db3').rename(f'motor/motor_{part}.db3')

report = repair('motor')
told = yaml.safe_load(Path('motor/metadata.yaml').read_text())['rosbag2_bagfile_information']
print(told['relative_file_paths'])
assert report.message_count == 120 and told['duration']['nanoseconds'] == 119 * 10**8
assert told['relative_file_paths'] == [f'motor_{part}.db3' for part in sorted(map(str, range(12)))]
with Reader('motor') as bag:
    read = [(time - START * 10**9, store.deserialize_cdr(data, kind).position[0]) for _, time, data in bag.messages()]
seconds = [int(angle) for time, angle in read[::10]]
print('angles at the start of each file:', seconds)
assert all(time == round(angle * 10) * 10**8 for time, angle in read)
assert seconds == [0, 1, 10, 11, 2, 3, 4, 5, 6, 7, 8, 9]
PYTHON

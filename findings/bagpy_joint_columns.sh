#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# bagpy 0.5: where a JointState has other joints or no velocities, its table has efforts as velocities, or a velocity as
# a position.
#
# Expected of message_by_topic(): a table with the columns position_0, position_1, velocity_0 and so on, each with its
# field of each message. What happens: the columns are those of the first message, and the numbers of each later one are
# written side by side from position_0 on, whatever their count. Where a driver sends no velocities for one message, its
# efforts of 5 and 6 N·m are the velocities of 5 and 6 rad/s. Where a second driver on the topic has one joint, at 0.7
# rad, 0.07 rad/s and 7 N·m, the second joint is at 0.07 rad, and the first one turns at 7 rad/s. There is neither an
# error nor a warning.
# For us: take only topics whose messages are all alike in length, or read them with rosbags by the names of the joints.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check bagpy==0.5 rosbags==0.11.9 numpy==2.4.6 pandas==3.1.1
cd "$folder"
MPLBACKEND=Agg timeout 120 venv/bin/python - <<'PYTHON'
import bagpy
import numpy as np
import pandas as pd
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_typestore

store = get_typestore(Stores.ROS1_NOETIC)
kind = 'sensor_msgs/msg/JointState'
both = ['motor', 'output']
messages = [
    (both, [0.1, 0.2], [0.01, 0.02], [1.0, 2.0]),
    (both, [0.3, 0.4], [0.03, 0.04], [3.0, 4.0]),
    (both, [0.5, 0.6], [], [5.0, 6.0]),
    (['gripper'], [0.7], [0.07], [7.0]),
]
with Writer('joints.bag') as bag:
    topic = bag.add_connection('/joint_states', kind, typestore=store)
    for second, (names, *fields) in enumerate(messages, 1):
        stamp = store.types['builtin_interfaces/msg/Time'](second, 0)
        header = store.types['std_msgs/msg/Header'](second, stamp, '')
        message = store.types[kind](header, names, *map(np.array, fields))
        bag.write(topic, second * 10**9, store.serialize_ros1(message, kind))

table = pd.read_csv(bagpy.bagreader('joints.bag', verbose=False).message_by_topic('/joint_states'))
columns = [f'{field}_{joint}' for field in ('position', 'velocity', 'effort') for joint in (0, 1)]
print(table[['name', *columns]].to_string())
rows = [[None if pd.isna(value) else value for value in row] for row in table[columns].to_numpy()]
assert rows[:2] == [[0.1, 0.2, 0.01, 0.02, 1.0, 2.0], [0.3, 0.4, 0.03, 0.04, 3.0, 4.0]]
assert rows[2:] == [[0.5, 0.6, 5.0, 6.0, None, None], [0.7, 0.07, 7.0, None, None, None]]
PYTHON

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# forge-robotics 0.2.0: of a joint that rests for 6 of 10 s, the static share is 60 % where it rests at 0 rad, and 0 %
# at 1 rad.
#
# Expected of its "static detection", said to be the share of time in which the robot is not moving: 0.6 in each of
# three recordings of a joint and its goal that rest for 6 of 10 s. What happens: 0.6 where it rests at 0 rad, and 0
# where it rests at 1 rad, before or after the motion. The size of the goal is compared with zero, not its change. The
# share of dead actions, said to be zero or constant ones, is 0.6 if the joint rests first, and 0 if it rests last: only
# what equals the first goal counts as constant. And `forge convert` from mcap to mcap sends positions through a
# float32, by default: a joint that turns from 100000.003 rad at 1 mrad/s stands for seconds and then jumps by 7.8 mrad.
# For us: find rests from the differences of the angles; give `dtype: float64` for multi-turn joints.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    forge-robotics==0.2.0 mcap-ros2-support==0.6.0 mcap-protobuf-support==0.6.0 mcap==1.6.0 rosbags==0.11.9
cd "$folder"
PATH="$folder/venv/bin:$PATH"
timeout 200 python - <<'PYTHON'
import json
import subprocess

import numpy as np
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

START = 1795838400
store = get_typestore(Stores.ROS2_JAZZY)
kind = 'sensor_msgs/msg/JointState'


def record(name, times, angles):
    with Writer(name, version=9, storage_plugin=StoragePlugin.MCAP) as bag:
        topics = [bag.add_connection(topic, kind, typestore=store) for topic in ('/joint_states', '/action')]
        for time, angle in zip(times, angles):
            nanoseconds = round(time * 1e9)
            stamp = store.types['builtin_interfaces/msg/Time'](START + nanoseconds // 10**9, nanoseconds % 10**9)
            header = store.types['std_msgs/msg/Header'](stamp, '')
            message = store.types[kind](header, ['shaft'], np.array([angle]), np.array([]), np.array([]))
            for topic in topics:
                bag.write(topic, START * 10**9 + nanoseconds, store.serialize_cdr(message, kind))
    return f'{name}/{name}.mcap'


def run(*arguments):
    subprocess.run(['forge', *arguments], capture_output=True, check=True)


times = np.arange(0, 10, 0.02)
swing = np.sin(np.maximum(times - 6, 0))
found = {}
for name, angles in {'zero_first': swing, 'one_first': 1 + swing, 'one_last': (1 + swing)[::-1]}.items():
    run('quality', record(name, times, angles), '--export', 'report.json')
    (episode,) = json.load(open('report.json'))['per_episode']
    found[name] = [round(episode[key], 1) for key in ('static_fraction', 'dead_fraction')]
    print(f'{name}: static, dead {found[name]}, still {np.mean(np.abs(np.diff(angles)) < 1e-9):.1f}')
assert found == {'zero_first': [0.6, 0.6], 'one_first': [0.0, 0.6], 'one_last': [0.0, 0.0]}, found

run('convert', record('turns', times, 100000.003 + 0.001 * times), 'again', '--format', 'mcap')
with open('again/dataset.mcap', 'rb') as file:
    messages = make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages()
    angles = np.array([message.decoded_message.position[0] for message in messages if 'state' in message.channel.topic])
different = sorted({float(angle) for angle in angles})
print(f'written again: {len(angles)} angles, {different}')
assert len(angles) == 500 and different == [100000.0, 100000.0078125, 100000.015625]
PYTHON

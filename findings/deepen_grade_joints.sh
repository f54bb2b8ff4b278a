#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# deepen-grade 0.4.1: a shaft that turns evenly for 300 s is called idle, one that stands still is not, and joints of
# two topics are taken as one.
#
# Expected of its idle share: 0 % of a shaft that turns at 0.02 rad/s, and 100 % of one that stands still within one
# count of its encoder. What happens: 100 % and 0 %. Its table of checks speaks of a normalized velocity, without saying
# by what: positions are divided by the range of the recording, and slower than 0.5 % of it per second is idle: every
# even motion of more than 200 s is, and the noise of a joint at rest is a motion across its whole range. Expected of
# the messages of a motor and of its output on two topics: two joints. What happens: their messages are put into one row
# under the name of the motor's joint, which therefore jumps from one angle to the other: the share of its time near its
# ends falls from 18 % to 0 %, and its smoothness, the logarithm of a jerk, from -19 to -25.
# For us: give it recordings of one topic, of a similar length and without rests; `gearkin validate` reads both topics.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    deepen-grade==0.4.1 mcap-ros2-support==0.6.0 mcap==1.6.0 rosbags==0.11.9
cd "$folder"
PATH="$folder/venv/bin:$PATH"
timeout 120 python - <<'PYTHON'
import json
import subprocess

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

START = 1795838400
store = get_typestore(Stores.ROS2_JAZZY)
kind = 'sensor_msgs/msg/JointState'


def graded(name, topics, times):
    """Write angles of one joint per topic, 1 ms apart, and grade the recording."""
    with Writer(name, version=9, storage_plugin=StoragePlugin.MCAP) as bag:
        connections = {topic: bag.add_connection(topic, kind, typestore=store) for topic in topics}
        for row, time in enumerate(times):
            for delay, (topic, (joint, angles)) in enumerate(topics.items()):
                nanoseconds = round(time * 1e9) + delay * 10**6
                stamp = store.types['builtin_interfaces/msg/Time'](START + nanoseconds // 10**9, nanoseconds % 10**9)
                header = store.types['std_msgs/msg/Header'](stamp, '')
                message = store.types[kind](header, [joint], angles[row : row + 1], np.array([]), np.array([]))
                bag.write(connections[topic], START * 10**9 + nanoseconds, store.serialize_cdr(message, kind))
    command = ['deepen', 'grade', '--json', f'{name}/{name}.mcap']
    report = json.loads(subprocess.run(command, capture_output=True, check=True, text=True).stdout)
    checks = {check['check_id'].split('.')[1]: check['details'] for check in report['episodes'][0]['checks']}
    idle = checks['idle_stall']['stall_frac']
    smooth = checks['jerk_smoothness']['ldj']
    ends = checks['joint_limit_saturation'].get('per_dim_saturation_frac')
    print(f'{name}: idle {idle}, smoothness {smooth}, near its ends {ends}')
    return idle, smooth, ends


long, short = np.arange(0, 300, 0.02), np.arange(0, 60, 0.02)
count = 2 * np.pi / 4096
noise = count * np.random.default_rng(0).integers(0, 2, len(short))
assert graded('even', {'/joint_states': ('shaft', 0.02 * long)}, long)[0] == 1
assert graded('still', {'/joint_states': ('shaft', 1 + noise)}, short)[0] == 0

motor = {'/motor/joint_states': ('motor', 20 * np.sin(short))}
output = {'/output/joint_states': ('output', np.sin(short))}
_, alone, ends = graded('motor', motor, short)
assert ends == {'motor': 0.18} and -20 < alone < -19, (ends, alone)
_, both, ends = graded('both', motor | output, short)
assert ends == {'motor': 0.0} and -26 < both < -25, (ends, both)
PYTHON

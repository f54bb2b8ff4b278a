#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# baglab 1.1.0: the stamps of an mcap are put into 1969 and repeat every 4.3 s, and the delay of a joint at 1 rad is 0.
#
# Ten messages of a joint, one a second. Expected of reindex_by_stamp(): the times of their headers. What happens: where
# baglab-mcap-backend has read them, their seconds have 32 bits, in which the nanoseconds overflow, without a warning:
# the times lie around 1970 and go back by 4.29 s after each fourth. backend='rosbags' gives the right ones.
# delay_estimate() of a motion that follows its command by 50 ms is right around 0 rad, and 0 around 1 rad: the mean is
# not removed.
# For us: use stamp_to_sec(), which is right with both; subtract the means before delay_estimate().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    baglab==1.1.0 baglab-mcap-backend==1.1.0 rosbags==0.11.9 scipy==1.17.1 pandas==3.1.1
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import baglab
import numpy as np
import pandas as pd
from baglab.analysis import delay_estimate
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

START = 1795838400
store = get_typestore(Stores.ROS2_JAZZY)
kind = 'sensor_msgs/msg/JointState'
with Writer('bag', version=9, storage_plugin=StoragePlugin.MCAP) as bag:
    topic = bag.add_connection('/joint_states', kind, typestore=store)
    for second in range(10):
        stamp = store.types['builtin_interfaces/msg/Time'](START + second, 0)
        header = store.types['std_msgs/msg/Header'](stamp, '')
        message = store.types[kind](header, ['rotor'], np.array([0.1]), np.array([]), np.array([]))
        bag.write(topic, (START + second) * 10**9, store.serialize_cdr(message, kind))


def read(backend):
    with baglab.load('bag', backend=backend, use_cache=False) as bag:
        rows = bag['/joint_states']
    assert baglab.stamp_to_sec(rows).tolist() == [START + second for second in range(10)]
    return baglab.reindex_by_stamp(rows).index


right, wrong = read('rosbags'), read('mcap')
steps = wrong.diff().total_seconds()[1:].tolist()
print('rosbags', right[0], 'mcap', wrong[0], 'steps', [round(step, 2) for step in steps])
assert right[0] == pd.Timestamp(START, unit='s')
assert all(abs(time.year - 1970) <= 1 for time in wrong)
assert {round(step, 2) for step in steps} == {1.0, -3.29}

times = pd.Series(np.arange(0.0, 4.0, 0.01))
delays = {}
for mean in (0.0, 1.0):
    command, answer = (mean + 0.3 * np.sin(2 * np.pi * (times - lag)) for lag in (0.0, 0.05))
    delays[mean] = round(delay_estimate(command, answer, times), 3)
print('delay by mean', delays)
assert delays == {0.0: 0.05, 1.0: 0.0}
PYTHON

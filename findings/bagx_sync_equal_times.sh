#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# bagx 0.6.0: an output published 0.2 ms after its rotor has a delay of 4.5 s if two messages have the same time.
#
# analyze_sync(), and the command `bagx sync`, look for the nearest message of the second topic for each message of the
# first. Expected of two topics at 1 kHz for 10 s: a mean delay of 0.2 ms. What happens: the search goes on only while
# the next message is nearer, and so it stays for good where two messages of the second topic have the same time. From
# there on the delay grows by a second each second. Under simulated time all recordings are so: with a /clock of 100 Hz,
# ten messages share each time, and the delay between two topics that are published together is 4995 ms instead of 0.
# With the topics exchanged, the first recording has 0.2 ms. Both are plain mcap files with a JointState a message.
# For us: `gearkin validate` finds the answer of each message by its stamp.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    bagx==0.6.0 mcap==1.6.0 mcap-ros2-support==0.6.0 rosbags==0.11.9 numpy==2.4.6
cd "$folder"
timeout 120 venv/bin/python - <<'PYTHON'
import numpy as np
from bagx.sync import analyze_sync
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

KIND = 'sensor_msgs/msg/JointState'
store = get_typestore(Stores.ROS2_JAZZY)


def message(time_ns):
    """A JointState whose stamp is the time at which it is recorded."""
    stamp = store.types['builtin_interfaces/msg/Time'](time_ns // 10**9, time_ns % 10**9)
    header = store.types['std_msgs/msg/Header'](stamp, '')
    return store.serialize_cdr(store.types[KIND](header, ['joint'], np.array([1.0]), np.array([]), np.array([])), KIND)


def delays(name, rotor, output):
    """The mean delays in ms between rotor and output, in both orders of the topics."""
    with Writer(name, version=9, storage_plugin=StoragePlugin.MCAP) as bag:
        topics = {topic: bag.add_connection(topic, KIND, typestore=store) for topic in ('/rotor', '/output')}
        times = [(time, '/rotor') for time in rotor] + [(time, '/output') for time in output]
        for time, topic in sorted(times):
            bag.write(topics[topic], time, message(time))
    orders = ('/rotor', '/output'), ('/output', '/rotor')
    return tuple(round(analyze_sync(name, *order).pairs[0].mean_delay_ms, 1) for order in orders)


rotor = [1795838400 * 10**9 + 10**6 * index for index in range(10_000)]
output = [time + 200_000 for time in rotor]
twice = output[:500] + [output[501]] + output[501:]
clock = [rotor[index - index % 10] for index in range(10_000)]
found = {
    'all times differ': delays('differ', rotor, output),
    'two are equal': delays('equal', rotor, twice),
    'simulated time': delays('simulated', clock, clock),
}
print(found)
assert found == {
    'all times differ': (0.2, 0.2), 'two are equal': (4510.9, 0.2), 'simulated time': (4995.0, 4995.0)
}
PYTHON

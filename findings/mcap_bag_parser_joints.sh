#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mcap-bag-parser 0.3.1: after the first JointState, angles are put under the names of other joints.
#
# The table has a column for each joint, as position.m1, but takes the names from the first message of the topic
# alone. The order of joints may differ from message to message, and other devices may publish on the
# topic: of [m2, m1] the angle of m2 is under m1, and that of a gripper is, too, which has no column of its own.
# Expected: position.m1 is the angle of m1 or NaN.
# For us: gearkin looks the joint up by its name in every message, so its results differ from such a table.
#
# Exit code 0: still so. Installs the packages into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mcap-bag-parser==0.3.1 rosbags==0.11.9
cd "$folder"
venv/bin/python - <<'PYTHON'
from pathlib import Path

import numpy as np
from mcap_bag import parse_mcap_file
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

TYPE = 'sensor_msgs/msg/JointState'
store = get_typestore(Stores.ROS2_JAZZY)
types = store.types
header = types['std_msgs/msg/Header'](types['builtin_interfaces/msg/Time'](1, 0), '')
with Writer(Path('bag'), version=9, storage_plugin=StoragePlugin.MCAP) as writer:
    connection = writer.add_connection('/joint_states', TYPE, typestore=store)
    for time, angles in enumerate(({'m1': 1.0, 'm2': 2.0}, {'m2': 2.0, 'm1': 1.0}, {'grip': 9.0})):
        fields = [np.array(values) for values in (list(angles.values()), [0.0], [0.0])]
        message = types[TYPE](header, list(angles), *fields)
        writer.write(connection, time, store.serialize_cdr(message, TYPE))
[path] = Path('bag').glob('*.mcap')
table = parse_mcap_file(str(path))['/joint_states'].filter(like='position')
print(table)
assert table.columns.tolist() == ['position.m1', 'position.m2']
assert table['position.m1'].tolist() == [1.0, 2.0, 9.0]
PYTHON

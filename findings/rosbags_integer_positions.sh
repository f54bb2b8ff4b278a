#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rosbags 0.11.9: positions of 1 and 2 rad in a numpy array of integers are written as 5e-324 and 1e-323 rad, without an
# error.
#
# Expected of an array of integers in a float64[] of a JointState: the same numbers, or an error, as an array of float32
# or a list raises one. What happens: the bits of 64-bit integers are written as they are, in an mcap, a .db3 and a ROS
# 1 bag, and read back as numbers next to zero: np.array([0, 1]), np.arange() and np.zeros_like() of counts make such
# arrays. In an array of big-endian floats, as of an HDF5 file of another machine, 1.5 rad are 3.1e-319 rad in ROS 2;
# for ROS 1 the bytes are swapped. The type hints of the messages ask for float64, but nothing compares the type of an
# array with them, only its size in bytes.
# For us: give `np.asarray(angles, dtype=np.float64)` to each message that is written.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check rosbags==0.11.9 numpy==2.4.6
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
from pathlib import Path

import numpy as np
from rosbags.highlevel import AnyReader
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

kind = 'sensor_msgs/msg/JointState'
new, old = get_typestore(Stores.ROS2_JAZZY), get_typestore(Stores.ROS1_NOETIC)


def written(name, positions):
    """The positions of one message that is written to a recording and read from it again."""
    store = old if name.endswith('.bag') else new
    stamp = store.types['builtin_interfaces/msg/Time'](1795838400, 0)
    header = store.types['std_msgs/msg/Header'](*([0] if store is old else []), stamp, '')
    message = store.types[kind](header, ['motor', 'output'], positions, np.array([]), np.array([]))
    if store is old:
        with Writer1(name) as bag:
            bag.write(bag.add_connection('/joint_states', kind, typestore=store), 1, store.serialize_ros1(message, kind))
    else:
        plugin = StoragePlugin.MCAP if 'mcap' in name else StoragePlugin.SQLITE3
        with Writer(name, version=9, storage_plugin=plugin) as bag:
            bag.write(bag.add_connection('/joint_states', kind, typestore=store), 1, store.serialize_cdr(message, kind))
    with AnyReader([Path(name)]) as bag:
        ((connection, _, data),) = bag.messages()
        return bag.deserialize(data, connection.msgtype).position.tolist()


for name in ('mcap', 'db3', 'ros1'):
    suffix = '.bag' if name == 'ros1' else ''
    assert written(f'{name}_floats{suffix}', np.array([1.0, 2.0])) == [1.0, 2.0]
    found = written(f'{name}_integers{suffix}', np.array([1, 2]))
    print(f'{name}: [1, 2] is read as {found}')
    assert found == [5e-324, 1e-323]
    swapped = written(f'{name}_big_endian{suffix}', np.array([1.5, 2.5], '>f8'))
    print(f'{name}: big-endian [1.5, 2.5] is read as {swapped}')
    assert swapped == [1.5, 2.5] if name == 'ros1' else max(swapped) < 1e-300

for name, wrong in {'float32': np.array([1.0, 2.0], np.float32), 'list': [1.0, 2.0]}.items():
    try:
        written(name, wrong)
    except (ValueError, AttributeError) as error:
        print(f'{name} is refused: {error}')
    else:
        raise AssertionError('not refused')
PYTHON

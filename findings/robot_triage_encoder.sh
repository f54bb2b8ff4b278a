#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# robot-triage 0.1.0: an encoder that is stuck for 10 s, or gives NaN, is no issue in a JointState, in a Float64 it is.
#
# Its detectors are said to flag "a topic still publishing but the value stopped changing", as of "an encoder wedged at
# one count", and a value that leaves its range or is NaN. What happens: whole messages are compared, and a JointState
# has another stamp each time, so that a stuck encoder is not seen; it is where the stamps are 0. A rule for the field
# `position` is accepted, but a list of an mcap is never compared with the limits, and no path reaches its elements: 0.6
# rad, where the limit is 0.5 rad, or NaN, is "No issues detected". The README speaks of values; only a comment in the
# source speaks of identical messages.
# For us: `gearkin validate` rejects NaN. Record what is to be watched as a Float64 as well; a clean report says nothing
# about joints.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    robot-triage==0.1.0 mcap-ros2-support==0.6.0 mcap==1.6.0 rosbags==0.11.9
cd "$folder"
PATH="$folder/venv/bin:$PATH"
timeout 120 python - <<'PYTHON'
import subprocess
from pathlib import Path

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

START = 1795838400
store = get_typestore(Stores.ROS2_JAZZY)
joint_state, float64 = 'sensor_msgs/msg/JointState', 'std_msgs/msg/Float64'
RULE = """detectors:
  range:
    rules:
      - {topic: /encoder, field: 'FIELD', low: -0.5, high: 0.5, label: shaft}
"""


def stamped(nanoseconds, angle):
    stamp = store.types['builtin_interfaces/msg/Time'](START + nanoseconds // 10**9, nanoseconds % 10**9)
    header = store.types['std_msgs/msg/Header'](stamp, '')
    return store.types[joint_state](header, ['shaft'], np.array([angle]), np.array([]), np.array([]))


def unstamped(_, angle):
    return stamped(-START * 10**9, angle)


def plain(_, angle):
    return store.types[float64](angle)


def issues(name, kind, message, angles, field=None):
    """The names of the detectors that find something in 20 s of angles of 50 Hz."""
    with Writer(name, version=9, storage_plugin=StoragePlugin.MCAP) as bag:
        topic = bag.add_connection('/encoder', kind, typestore=store)
        for row, angle in enumerate(angles):
            time = row * 20 * 10**6
            bag.write(topic, START * 10**9 + time, store.serialize_cdr(message(time, float(angle)), kind))
    Path('rule.yaml').write_text(RULE.replace('FIELD', field) if field else '')
    command = ['robot-triage', 'run', f'{name}/{name}.mcap', '--config', 'rule.yaml']
    report = subprocess.run(command, capture_output=True, check=True, text=True).stdout
    print(name, *(line for line in report.splitlines()[2:] if line))
    return {word for word in ('freeze', 'range') if f'{word}:' in report}


times = np.arange(0, 20, 0.02)
stuck = np.where((times > 5) & (times < 15), 0.3, 0.3 * np.sin(times))
assert issues('stuck_joint', joint_state, stamped, stuck) == set()
assert issues('stuck_without_stamps', joint_state, unstamped, stuck) == {'freeze'}
assert issues('stuck_float', float64, plain, stuck) == {'freeze'}

for name, value in (('beyond', 0.6), ('nan', np.nan)):
    angles = np.where(times > 10, value, 0.3 * np.sin(times))
    for field in ('position', 'position.0', 'position[0]'):
        where = field.translate({ord(sign): '_' for sign in '.[]'})
        assert 'range' not in issues(f'{name}_joint_{where}', joint_state, stamped, angles, field)
    assert 'range' in issues(f'{name}_float', float64, plain, angles, 'data')
PYTHON

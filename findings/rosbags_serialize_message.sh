#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rosbags 0.11.9: a JointState that rclpy has serialized is refused, unless it has all fields.
#
# rclpy.serialization.serialize_message (7.1.6, with rmw_fastrtps) returns more bytes than the message needs where
# sequences of doubles are empty: 60 in place of 52 of one with a position alone. rosbags accepts up to 3 bytes behind a
# message, and says "CDR message size mismatch". deserialize_message of rclpy reads it.
# A node that writes its own bag by rosbag2_py, as in the tutorials of ROS, stores such bytes. A message that comes
# over the network has 52, so that recordings of `ros2 bag record` are read.
# For us: gearkin reads these bags; programs that use rosbags do not.
#
# Exit code 0: still so. Installs the packages into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    'ros-jazzy-rclpy[fastrtps]==7.1.6' ros-jazzy-sensor-msgs==5.3.6 rosbags==0.11.9
"$folder/venv/bin/python" - <<'PYTHON'
from rclpy.serialization import deserialize_message, serialize_message
from rosbags.serde import SerdeError
from rosbags.typesys import Stores, get_typestore
from sensor_msgs.msg import JointState

store = get_typestore(Stores.ROS2_JAZZY)
full = {'velocity': [2.0], 'effort': [3.0]}
for fields, length, refused in ((full, 76, False), ({'velocity': [2.0]}, 68, True), ({}, 60, True)):
    message = JointState(name=['m1'], position=[1.0], **fields)
    data = serialize_message(message)
    assert len(data) == length and deserialize_message(data, JointState) == message
    try:
        store.deserialize_cdr(data, 'sensor_msgs/msg/JointState')
        outcome = 'is read'
    except SerdeError as error:
        outcome = str(error)
    print(fields, len(data), outcome)
    assert outcome.endswith("mismatch for 'sensor_msgs/msg/JointState'.") == refused
PYTHON

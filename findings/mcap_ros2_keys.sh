#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mcap-ros2-support 0.6.0: a JointState is written without its positions, or its nanoseconds, if a key has another name.
#
# Expected of a dict with a key that the message has not: an error, as rclpy and rosbags give. What happens: the key is
# dropped, and the field that lacks is empty or 0. So positions (for position) are written as no position at all, and a
# stamp of sec and nsec, as in Protobuf and ROS 1, has whole seconds: a thousand messages of 1 kHz with one stamp.
# For us: such a rotor is rejected as without a position, or as duplicate; nanosec and position are the names.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mcap-ros2-support==0.6.0 mcap==1.6.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import io

from mcap_ros2.reader import read_ros2_messages
from mcap_ros2.writer import Writer

DEFINITION = '''std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec'''
stream = io.BytesIO()
writer = Writer(stream)
schema = writer.register_msgdef('sensor_msgs/msg/JointState', DEFINITION)
for message in (
    {'header': {'stamp': {'sec': 5, 'nanosec': 1000000}}, 'name': ['rotor'], 'position': [1.5]},
    {'header': {'stamp': {'sec': 5, 'nsec': 1000000}}, 'name': ['rotor'], 'positions': [1.5]},
):
    writer.write_message('/joint_states', schema, message, log_time=1, publish_time=1)
writer.finish()
stream.seek(0)
right, wrong = (item.ros_msg for item in read_ros2_messages(stream))
print(right)
print(wrong)
assert right.header.stamp.nanosec == 1000000 and right.position == [1.5]
assert wrong.header.stamp.nanosec == 0 and wrong.position == [] and wrong.name == ['rotor']
PYTHON

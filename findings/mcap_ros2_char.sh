#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mcap-ros2-support 0.6.0: a temperature of 200 °C in a char of ROS 2 is read as -56 °C, and cannot be written.
#
# In a message of ROS 2, a char has no sign: rosidl_adapter makes an uint8 of it, and the class of std_msgs/Char names
# the range 0 to 255. rclpy 7.1.6 serializes a Char of 200. Expected of mcap-ros2-support: 200, as rosbags reads. What
# happens: -56, without an error, and a char[] of 200 and 255 is read as -56 and -1. Writing 200 is an error of struct,
# which takes -128 to 127. An uint8 and a byte are right.
# For us: take `value & 0xFF`, and write -56 for 200.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    mcap-ros2-support==0.6.0 mcap==1.6.0 rosbags==0.11.9 numpy==2.4.6 \
    'ros-jazzy-rclpy[fastrtps]==7.1.6' ros-jazzy-std-msgs==5.3.6
cat > "$folder/char.py" <<'PYTHON'
import struct

import mcap_ros2._dynamic as mcap_ros2
from rclpy.serialization import serialize_message
from rosbags.typesys import Stores, get_typestore
from std_msgs.msg import Char

NAME = 'std_msgs/msg/Char'
data = bytes(serialize_message(Char(data=200)))
store = get_typestore(Stores.ROS2_JAZZY)
found = mcap_ros2.generate_dynamic(NAME, 'char data')[NAME](data).data
print(f'rclpy: {data[4]}, rosbags: {store.deserialize_cdr(data, NAME).data}, mcap-ros2-support: {found}')
assert store.deserialize_cdr(data, NAME).data == data[4] == 200 and found == -56
try:
    Char(data=-56, check_fields=True)
except AssertionError as error:
    print('std_msgs:', error)
    assert '[0, 255]' in str(error)
else:
    raise SystemExit('std_msgs takes -56')

TEXT = 'char[] values\nuint8[] numbers\nbyte[] flags'
MIXED = 'drive_msgs/msg/Mixed'
write = mcap_ros2.serialize_dynamic(MIXED, TEXT)[MIXED]
read = mcap_ros2.generate_dynamic(MIXED, TEXT)[MIXED]
message = read(write({'values': [-56, -1], 'numbers': [200, 255], 'flags': [200, 255]}))
values, numbers, flags = list(message.values), list(message.numbers), list(message.flags)
print('char[]', values, 'uint8[]', numbers, 'byte[]', flags)
assert (values, numbers, flags) == ([-56, -1], [200, 255], [200, 255])
try:
    write({'values': [200], 'numbers': [], 'flags': []})
except struct.error as error:
    print('written:', error)
else:
    raise SystemExit('200 is written')
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/char.py"

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pybag-sdk 0.13.0: of a ROS 1 bag that it converts to MCAP for ROS 2, a ROS 2 node can read no message with a header.
#
# "pybag convert" writes MCAP with the profile "ros2" and CDR by default. Expected of a JointState: the message of
# ROS 2, whose header has a stamp and a frame. What happens: the stamp becomes one of ROS 2, but the field seq, which
# only ROS 1 has, stays in the header and in the schema. A node of ROS 2 knows JointState by its name alone: it takes
# seq for the seconds and the nanoseconds for the length of frame_id, and rclpy refuses each of 100 messages, whose
# bytes "ros2 bag play" would send as they are. The command ends with 0 and no warning, and a viewer that reads the
# schema in the file shows all of it right.
# For us: convert such bags by rosbags-convert with --dst-typestore ros2_jazzy.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check pybag-sdk==0.13.0 mcap-ros2-support==0.6.0 mcap==1.6.0 \
    numpy==2.4.6 'ros-jazzy-rclpy[fastrtps]==7.1.6' ros-jazzy-common-interfaces==5.3.6
timeout 60 venv/bin/python - <<'PYTHON'
from pybag.bag_writer import BagFileWriter
from pybag.ros1.noetic import sensor_msgs, std_msgs
from pybag.types import Time

with BagFileWriter.open('arm.bag') as bag:
    for number in range(100):
        stamp = 1_700_000_000_123_456_789 + number * 10_000_000
        header = std_msgs.Header(seq=number, stamp=Time(*divmod(stamp, 10**9)), frame_id='base')
        state = sensor_msgs.JointState(
            header=header, name=['arm'], position=[0.01 * number], velocity=[1.0], effort=[0.5]
        )
        bag.write_message('/joint_states', stamp, state)
PYTHON
venv/bin/pybag convert arm.bag -o arm.mcap
timeout 60 venv/bin/python - <<'PYTHON'
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

shown = refused = 0
with open('arm.mcap', 'rb') as file:
    reader = make_reader(file, decoder_factories=[DecoderFactory()])
    assert reader.get_header().profile == 'ros2'
    for schema, _, message, decoded in reader.iter_decoded_messages():
        assert schema.name == 'sensor_msgs/msg/JointState' and b'uint32 seq' in schema.data
        assert decoded.header.stamp.sec >= 1_700_000_000
        shown += decoded.position == [0.01 * decoded.header.seq]
        try:
            deserialize_message(message.data, JointState)
        except Exception as error:
            reason = str(error)
            refused += 1
print(shown, 'messages are right by their schema; rclpy refuses', refused, ':', reason[:100])
assert (shown, refused) == (100, 100)
PYTHON

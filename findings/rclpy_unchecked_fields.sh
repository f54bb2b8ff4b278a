#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rclpy 7.1.6 and 9.1.2: a Float64 of the whole number 1 is published as 5e-324, and the joint name 'elbow' as five
# joints.
#
# Expected of Float64(data=1), a whole number as a slider or a file gives it: 1.0, or an error. What happens: the
# message shows 1, and its subscribers get 5e-324, as the size of the whole number is taken for the bits of the double;
# of -3 they get nan, of 0 zero. Int16(data=40000) is received as -25536, Bool(data=2) as False, and
# JointState(name='elbow') as five joints of a letter each. In Humble each of these is an AssertionError; since Jazzy
# fields are checked only if ROS_PYTHON_CHECK_FIELDS is 1. Sequences of doubles, as the positions of a JointState, are
# converted: [1] is received as 1.0.
# For us: in a driver, give float(value), and a list of names; test it with ROS_PYTHON_CHECK_FIELDS=1.
#
# Exit code 0: still so. Installs the wheels into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/fields.py" <<'PYTHON'
import time

import rclpy
from rclpy.executors import SingleThreadedExecutor
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float64, Int16

rclpy.init()
sender, receiver = rclpy.create_node('sender'), rclpy.create_node('receiver')
executor = SingleThreadedExecutor()
executor.add_node(sender)
executor.add_node(receiver)


def received(message):
    got = []
    topic = '/' + type(message).__name__.lower()
    publisher = sender.create_publisher(type(message), topic, 1)
    subscription = receiver.create_subscription(type(message), topic, got.append, 1)
    deadline = time.monotonic() + 30
    while not got and time.monotonic() < deadline:
        publisher.publish(message)
        executor.spin_once(0.1)
    receiver.destroy_subscription(subscription)
    sender.destroy_publisher(publisher)
    return got[0]


for value in (1, 1000, -3, 0, 1.0):
    data = received(Float64(data=value)).data
    print('Float64 of', value, 'is received as', data)
    assert data == value if value == 0 or isinstance(value, float) else not abs(data) > 1e-300
assert received(Int16(data=40000)).data == -25536
assert received(Bool(data=2)).data is False
joints = received(JointState(name='elbow', position=[1]))
print(joints.name, list(joints.position))
assert joints.name == list('elbow') and list(joints.position) == [1.0]
rclpy.shutdown()
PYTHON
export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_LOG_DIR="$folder/log"
for wheels in 'ros-jazzy-rclpy[fastrtps]==7.1.6 ros-jazzy-sensor-msgs==5.3.6' 'ros-kilted-rclpy[fastrtps]==9.1.2 ros-kilted-sensor-msgs==5.5.1'; do
    rm -rf "$folder/venv"
    python3 -m venv "$folder/venv"
    "$folder/venv/bin/pip" install --quiet --disable-pip-version-check $wheels
    echo "$wheels"
    timeout 200 "$folder/venv/bin/python" "$folder/fields.py"
    if ROS_PYTHON_CHECK_FIELDS=1 timeout 60 "$folder/venv/bin/python" "$folder/fields.py" > "$folder/out" 2>&1; then exit 1; fi
    grep "AssertionError: The 'data' field must be of type 'float'" "$folder/out"
done

#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rclpy 7.1.6 and 9.1.2: a driver that is connected but has never sent does not miss a deadline of 0.1 s in 2 s.
#
# A watchdog subscribes to joint states with a deadline of 0.1 s and a callback for missed ones; the driver offers the
# same deadline. Expected: the callback is called 0.1 s after the driver is there, if it sends nothing, as after a fault
# at its start. What happens, with Fast DDS: no call in 2 s. The time begins with the first message: after one message
# and silence the callback comes each 0.1 s. A driver whose process ends after its first message is told in this way,
# one that hangs before it is not.
# For us: the diagnostics of the node report it after input_timeout; in a watchdog, use a timer beside the deadline.
#
# Exit code 0: still so. Installs the wheels into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/watch.py" <<'PYTHON'
import time

import rclpy
from rclpy.duration import Duration
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState

rclpy.init()
driver, watchdog = rclpy.create_node('driver'), rclpy.create_node('watchdog')
executor = SingleThreadedExecutor()
executor.add_node(driver)
executor.add_node(watchdog)
missed, received = [], []
profile = QoSProfile(depth=10, deadline=Duration(seconds=0.1))
watchdog.create_subscription(
    JointState, 'joint_states', received.append, profile,
    event_callbacks=SubscriptionEventCallbacks(deadline=missed.append),
)
publisher = driver.create_publisher(JointState, 'joint_states', profile)


def spin(seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        executor.spin_once(0.01)


deadline = time.monotonic() + 20
while not publisher.get_subscription_count() and time.monotonic() < deadline:
    spin(0.1)
assert publisher.get_subscription_count() == 1
spin(2.0)
silent = len(missed)
publisher.publish(JointState(name=['joint'], position=[0.0]))
spin(2.0)
print('connected and silent for 2 s:', silent, 'missed deadlines; after one message:', len(missed))
assert silent == 0 and len(received) == 1 and len(missed) >= 5
rclpy.shutdown()
PYTHON
export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_LOG_DIR="$folder/log"
for wheels in 'ros-jazzy-rclpy[fastrtps]==7.1.6 ros-jazzy-sensor-msgs==5.3.6' 'ros-kilted-rclpy[fastrtps]==9.1.2 ros-kilted-sensor-msgs==5.5.1'; do
    rm -rf "$folder/venv"
    python3 -m venv "$folder/venv"
    "$folder/venv/bin/pip" install --quiet --disable-pip-version-check $wheels
    echo "$wheels"
    timeout 100 "$folder/venv/bin/python" "$folder/watch.py"
done

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The baseline of start-up: an rclpy node that does nothing but report its first message."""

import time
from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException
from sensor_msgs.msg import JointState

heard: list[int] = []


def report(_: JointState) -> None:
    """Tell when the first message came."""
    if not heard:
        heard.append(time.time_ns())
        print(f'{{"heard": {heard[0]}}}', flush=True)


rclpy.init()
node = rclpy.create_node('empty_node')
node.create_subscription(JointState, 'rotor_state', report, 10)
with suppress(KeyboardInterrupt, ExternalShutdownException):
    rclpy.spin(node)

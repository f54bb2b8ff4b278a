# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What no node can save: an rclpy node that publishes the bytes of each message that it takes.

With the executor, the profile of Fast DDS and the bytes that the node has, and nothing computed.
"""

from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.qos import QoSProfile
from rclpy.task import Future
from sensor_msgs.msg import JointState

from gear_kinematics.ros.drivers import DEPTH
from gear_kinematics.ros.workarounds.executor import ENDLESS
from gear_kinematics.ros.workarounds.fastdds_profile import use_profile

use_profile()
rclpy.init()
node = rclpy.create_node('echo_node')
qos = QoSProfile(depth=DEPTH)
send = node.create_publisher(JointState, 'output_state', qos).handle.publish_raw


def echo(data: bytes) -> None:
    """Send it back; a function of Python, whose signature rclpy reads."""
    send(data)


node.create_subscription(JointState, 'rotor_state', echo, qos, raw=True)
executor = EventsExecutor()
executor.add_node(node)
with suppress(KeyboardInterrupt, ExternalShutdownException):
    executor.spin_until_future_complete(Future(), timeout_sec=ENDLESS)

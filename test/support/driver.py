# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A driver to be run as a process of its own, which can be killed at any moment."""

import time
from itertools import count

import rclpy
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState

SECOND = 1_000_000_000  # ns
MILLISECOND = SECOND // 1000
_BURST = 10  # messages
_PERIOD = 0.002  # s: not so fast that a listener on a busy machine falls behind by its queue
_MOMENT = Duration(nanoseconds=50 * MILLISECOND)
_ENDLESS = Duration(seconds=-1)


def rotor_position(stamp: int) -> float:
    """Where the rotor is at a stamp, rad: to and fro, elsewhere a millisecond later."""
    return 0.02 * (abs(stamp // MILLISECOND % 202 - 101) - 50)


def drive(topic: str, start: int, go, acknowledged) -> None:
    """Publish with the stamps from `start` ns on, a millisecond apart, until killed.

    Args:
        topic: the rotor's.
        start: ns.
        go: an event to wait for, when the node is known to hear this driver.
        acknowledged: its `value` becomes the last stamp that the node is known to have got.
    """
    rclpy.init()
    node = Node('driver')
    # A full history asks for acknowledgement at once, one with room every 3 s.
    publisher = node.create_publisher(JointState, topic, QoSProfile(depth=_BURST))
    while not publisher.get_subscription_count():
        time.sleep(0.01)
    arrived = False
    while not arrived:
        publisher.publish(JointState())  # no rotor in it
        arrived = publisher.wait_for_all_acked(_MOMENT)
    go.wait()
    message = JointState(name=['rotor'])
    for number, stamp in enumerate(count(start, MILLISECOND), start=1):
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
        message.position = [rotor_position(stamp)]
        publisher.publish(message)
        time.sleep(_PERIOD)
        if number % _BURST == 0:
            publisher.wait_for_all_acked(_ENDLESS)
            acknowledged.value = stamp

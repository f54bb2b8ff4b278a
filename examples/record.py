# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Record both encoders and the outputs of the node until the program that moves the rotor ends."""

import sys
import time
from contextlib import suppress

import rclpy
from geometry_msgs.msg import PoseArray
from sensor_msgs.msg import JointState

from gear_kinematics.bag.writing import BagWriter
from gear_kinematics.ros.workarounds.executor import make_executor

CONNECTING = 5.0  # s: nodes announce themselves every 3 s, and DDS can lose messages meanwhile
AFTERWARDS = 3.0  # s, of which the recording goes on after the last command
RECORDED = ('/rotor_state', '/output_encoder', '/output_state', '/body_poses')
rclpy.init()
node, commanded = rclpy.create_node('recorder'), [float('inf')]  # s
begin = time.monotonic() + CONNECTING
executor = make_executor()  # that of rclpy is too slow for four topics at 1 kHz
executor.add_node(node)
with BagWriter(sys.argv[1]) as bag, suppress(KeyboardInterrupt):  # Ctrl-C ends it, too
    for topic in RECORDED:

        def keep(data: bytes, topic: str = topic) -> None:
            if time.monotonic() > begin:
                bag.write(topic, time.time_ns(), data)

        kind, room = (PoseArray, 'geometry') if 'poses' in topic else (JointState, 'sensor')
        bag.add_topic(topic, f'{room}_msgs/msg/{kind.__name__}')
        node.create_subscription(kind, topic, keep, 2000, raw=True)
    node.create_subscription(
        JointState, '/rotor_command', lambda _: commanded.append(time.monotonic()), 2000, raw=True
    )
    while time.monotonic() < begin:
        executor.spin_once(timeout_sec=AFTERWARDS)
    print('recording', flush=True)
    while time.monotonic() < commanded[-1] + AFTERWARDS:
        executor.spin_once(timeout_sec=AFTERWARDS)

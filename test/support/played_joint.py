# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The drivers of a joint, as a process: `python played_joint.py READINGS.npy`, until killed.

The readings, (n, 3): s from 0, rad of the rotor, rad of the output's encoder, are played again and
again in their own time, on /motor/joint_states (m1, beside a brake) and /encoder/joint_states
(shaft). The first stamp, ns, is printed; the others follow exactly.
"""

import sys
import time

import numpy as np
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import JointState

ROTOR, ENCODER = '/motor/joint_states', '/encoder/joint_states'


def moments(seconds: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Time after the start, ns, and row of the readings of each of many messages."""
    after = np.round(seconds * 1e9).astype(np.int64)
    rounds, rows = np.divmod(np.arange(count), len(after))
    return rounds * (after[-1] + after[1]) + after[rows], rows


def main() -> None:
    """Publish until killed."""
    seconds, rotor, output = np.load(sys.argv[1]).T
    rclpy.init()
    node = Node('drivers')
    motor = node.create_publisher(JointState, ROTOR, 100)
    encoder = node.create_publisher(JointState, ENCODER, 100)
    start, first = time.monotonic(), time.time_ns()
    print(first, flush=True)
    after, rows = moments(seconds, 10**6)
    for moment, row in zip(after.tolist(), rows.tolist(), strict=True):
        time.sleep(max(0.0, start + 1e-9 * moment - time.monotonic()))
        message = JointState(name=['brake', 'm1'], position=[0.0, rotor[row]])
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(first + moment, 10**9)
        motor.publish(message)
        message.name, message.position = ['shaft'], [output[row]]
        encoder.publish(message)


if __name__ == '__main__':
    main()

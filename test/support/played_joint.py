# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The drivers of a joint, as a process that plays readings of its encoders again and again."""

import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState


def moments(seconds: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Time after the start, ns, and row of the readings of each of many messages."""
    after = np.round(seconds * 1e9).astype(np.int64)
    rounds, rows = np.divmod(np.arange(count), len(after))
    return rounds * (after[-1] + after[1]) + after[rows], rows


@contextmanager
def played(
    readings: np.ndarray, motor: str, encoder: str, every: int = 1, late: str = 'sent'
) -> Iterator[int]:
    """Run the drivers, and kill them at the end; yields the first stamp, ns.

    Args:
        readings: (n, 3), s from 0, rad of the rotor, rad of the output's encoder.
        motor: the topic of the rotor, which is m1 beside a brake.
        encoder: the topic of the output's encoder, `shaft`.
        every: of how many readings the encoder publishes one.
        late: whether readings that are late on a busy machine are 'sent' or 'left out'.
    """
    with tempfile.NamedTemporaryFile(suffix='.npy') as file:
        np.save(file, readings)
        file.flush()
        command = [sys.executable, __file__, file.name, motor, encoder, str(every), late]
        with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
            try:
                yield int(process.stdout.readline())
            finally:
                process.kill()


def main() -> None:
    """Publish until killed."""
    file, motor_topic, encoder_topic, every, late = sys.argv[1:]
    seconds, rotor, output = np.load(file).T
    after, rows = moments(seconds, 10**6)
    rclpy.init()
    node = Node('drivers')
    qos = QoSProfile(depth=2000)
    motor = node.create_publisher(JointState, motor_topic, qos)
    encoder = node.create_publisher(JointState, encoder_topic, qos)
    start, first = time.monotonic(), time.time_ns()
    print(first, flush=True)
    number = sent = -1
    while True:
        number += 1
        if late == 'left out':
            passed = int(1e9 * (time.monotonic() - start))  # a float would convert all of them
            due = np.searchsorted(after, passed, 'right') - 1
            number = max(number, int(due))
        moment, row = int(after[number]), rows[number]
        time.sleep(max(0.0, start + 1e-9 * moment - time.monotonic()))
        message = JointState(name=['brake', 'm1'], position=[0.0, rotor[row]])
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(first + moment, 10**9)
        motor.publish(message)
        if number // int(every) > sent:
            sent = number // int(every)
            message.name, message.position = ['shaft'], [output[row]]
            encoder.publish(message)


if __name__ == '__main__':
    main()

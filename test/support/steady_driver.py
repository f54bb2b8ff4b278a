# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A driver as a process of its own, at 1 kHz: `python steady_driver.py NAMESPACE`.

Beside the motor, joint m1 of several on motor/joint_states, it publishes the encoder of the output
at 100 Hz.
"""

import math
import sys
import time

import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState

MILLISECOND = 1_000_000  # ns
RATE = 1000  # Hz
RATIO = -19  # rotor speed / output speed
ERROR = 1e-4  # rad, amplitude of the transmission error
_PERIOD = 4.0  # s
_AMPLITUDE = 60.0  # rad


def rotor_position(seconds: float) -> float:
    """Where the rotor is, rad."""
    return _AMPLITUDE * math.sin(math.tau * seconds / _PERIOD)


def main() -> None:
    """Publish until killed."""
    rclpy.init()
    node = Node('motor', namespace=sys.argv[1])
    qos = QoSProfile(depth=2000)
    motor = node.create_publisher(JointState, 'motor/joint_states', qos)
    encoder = node.create_publisher(JointState, 'output_encoder', qos)
    start, first = time.monotonic(), time.time_ns()
    number = sent = -1
    print('drives', flush=True)
    while True:
        # On a busy machine it leaves messages out: late ones would look like a clock set back.
        number = max(number + 1, int(RATE * (time.monotonic() - start)))
        seconds = number / RATE
        time.sleep(max(0.0, start + seconds - time.monotonic()))
        stamp = first + number * MILLISECOND
        position = rotor_position(seconds)
        message = JointState(name=['brake', 'm1'], position=[0.0, position])
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 10**9)
        motor.publish(message)
        if number // 10 > sent:
            sent = number // 10
            angle = position / RATIO
            message.name = ['output']
            message.position = [angle + ERROR * math.sin(4.0 * angle)]
            encoder.publish(message)


if __name__ == '__main__':
    main()

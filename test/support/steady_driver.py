# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A driver as a process of its own, at a rate in Hz: `python steady_driver.py NAMESPACE RATE`.

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

SECOND = 1_000_000_000  # ns
ENCODER_RATE = 100  # Hz
RATIO = -19  # rotor speed / output speed
ERROR = 1e-4  # rad, amplitude of the transmission error
_PERIOD = 4.0  # s
_AMPLITUDE = 60.0  # rad


def rotor_position(seconds: float) -> float:
    """Where the rotor is, rad."""
    return _AMPLITUDE * math.sin(math.tau * seconds / _PERIOD)


def main() -> None:
    """Publish until killed."""
    namespace, rate = sys.argv[1], int(sys.argv[2])
    rclpy.init()
    node = Node('motor', namespace=namespace)
    qos = QoSProfile(depth=2000)
    motor = node.create_publisher(JointState, 'motor/joint_states', qos)
    encoder = node.create_publisher(JointState, 'output_encoder', qos)
    start, first = time.monotonic(), time.time_ns()
    number = sent = -1
    print('drives', flush=True)
    while True:
        # On a busy machine it leaves messages out: late ones would look like a clock set back.
        number = max(number + 1, int(rate * (time.monotonic() - start)))
        seconds = number / rate
        time.sleep(max(0.0, start + seconds - time.monotonic()))
        stamp = first + number * SECOND // rate
        position = rotor_position(seconds)
        message = JointState(name=['brake', 'm1'], position=[0.0, position])
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
        motor.publish(message)
        if number * ENCODER_RATE // rate > sent:
            sent = number * ENCODER_RATE // rate
            angle = position / RATIO
            message.name = ['output']
            message.position = [angle + ERROR * math.sin(4.0 * angle)]
            encoder.publish(message)


if __name__ == '__main__':
    main()

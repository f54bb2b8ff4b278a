# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The baseline of the benchmarks: the same job as the tutorials teach it.

Message objects, queues of ten, rclpy.spin; one actuator, and nothing but good input.
"""

import math

import rclpy
from geometry_msgs.msg import Pose, PoseArray
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import JointState

ECCENTRICITY = 0.0011  # m
GEAR_RATIO = -19.0
BRANCHES = ((0.0, 0.04), (math.pi, -0.04))  # cam phase (rad), axial position (m)


def output_angle(rotor_angle: float) -> float:
    """Eq. (5)."""
    return rotor_angle / GEAR_RATIO


def centres(rotor_angle: float) -> list[tuple[float, float, float]]:
    """Satellites, eqs. (9) and (10), then Oldham couplings, eqs. (20) to (22)."""
    phi = output_angle(rotor_angle)
    satellites, couplings = [], []
    for cam_phase, z in BRANCHES:
        theta = rotor_angle + cam_phase
        slide = ECCENTRICITY * math.cos(theta - phi)
        satellites.append((-ECCENTRICITY * math.sin(theta), ECCENTRICITY * math.cos(theta), z))
        couplings.append((-slide * math.sin(phi), slide * math.cos(phi), z))
    return satellites + couplings


class TextbookNode(Node):
    """Publishes output_state and body_poses for every message on rotor_state."""

    def __init__(self) -> None:
        """Open the topics."""
        super().__init__('textbook_node')
        self._output_state = self.create_publisher(JointState, 'output_state', 10)
        self._body_poses = self.create_publisher(PoseArray, 'body_poses', 10)
        self.create_subscription(JointState, 'rotor_state', self._on_rotor_state, 10)

    def _on_rotor_state(self, rotor: JointState) -> None:
        index = rotor.name.index('rotor')
        rotor_angle = rotor.position[index]

        state = JointState()
        state.header.stamp = rotor.header.stamp
        state.name = ['output_shaft']
        state.position = [output_angle(rotor_angle)]
        state.velocity = [rotor.velocity[index] / GEAR_RATIO]
        state.effort = [rotor.effort[index] * GEAR_RATIO]
        self._output_state.publish(state)

        poses = PoseArray()
        poses.header.stamp = rotor.header.stamp
        poses.header.frame_id = 'stator'
        half = 0.5 * math.remainder(output_angle(rotor_angle), math.tau)
        for x, y, z in centres(rotor_angle):
            pose = Pose()
            pose.position.x = x
            pose.position.y = y
            pose.position.z = z
            pose.orientation.z = math.sin(half)
            pose.orientation.w = math.cos(half)
            poses.poses.append(pose)
        self._body_poses.publish(poses)


def run(kind: type[Node]) -> None:
    """Run a node until it is stopped."""
    rclpy.init()
    node = kind()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    run(TextbookNode)

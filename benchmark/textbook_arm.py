# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The baseline of `arm.py`: one node for the gears of an arm, as the tutorials teach it.

Message objects, queues of ten, rclpy.spin; and nothing but good input.
"""

import math

from geometry_msgs.msg import Pose, PoseArray
from rclpy.node import Node
from sensor_msgs.msg import JointState
from textbook_node import GEAR_RATIO, centres, output_angle, run


class TextbookArm(Node):
    """Publishes output_state of all joints, and body_poses of each."""

    def __init__(self) -> None:
        """Open the topics."""
        super().__init__('textbook_arm')
        self._joints = self.declare_parameter('actuators', ['rotor']).value
        self._output_state = self.create_publisher(JointState, 'output_state', 10)
        self._body_poses = {
            joint: self.create_publisher(PoseArray, f'{joint}/body_poses', 10)
            for joint in self._joints
        }
        self.create_subscription(JointState, 'rotor_state', self._on_rotor_state, 10)

    def _on_rotor_state(self, rotor: JointState) -> None:
        state = JointState()
        state.header.stamp = rotor.header.stamp
        for joint in self._joints:
            index = rotor.name.index(joint)
            angle = output_angle(rotor.position[index])
            state.name.append(joint)
            state.position.append(angle)
            state.velocity.append(rotor.velocity[index] / GEAR_RATIO)
            state.effort.append(rotor.effort[index] * GEAR_RATIO)
            if self._body_poses[joint].get_subscription_count():
                poses = PoseArray()
                poses.header.stamp = rotor.header.stamp
                poses.header.frame_id = f'{joint}_stator'
                half = 0.5 * math.remainder(angle, math.tau)
                for x, y, z in centres(rotor.position[index]):
                    pose = Pose()
                    pose.position.x, pose.position.y, pose.position.z = x, y, z
                    pose.orientation.z, pose.orientation.w = math.sin(half), math.cos(half)
                    poses.poses.append(pose)
                self._body_poses[joint].publish(poses)
        self._output_state.publish(state)


if __name__ == '__main__':
    run(TextbookArm)

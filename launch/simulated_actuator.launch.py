# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Start an actuator without hardware: gear_simulator and gear_state_publisher."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

from gear_kinematics.twin.parameters import NODE


def generate_launch_description() -> LaunchDescription:
    """Declare the arguments, and start both nodes with them."""
    share = FindPackageShare('gear_kinematics')
    node = PathJoinSubstitution([share, 'launch', 'gear_state_publisher.launch.py'])
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                'config',
                default_value=PathJoinSubstitution([share, 'config', 'simulated_actuator.yaml']),
                description='parameter file of both nodes',
            ),
            # It declares the other arguments, and checks the file.
            IncludeLaunchDescription(node),
            IncludeLaunchDescription(node, launch_arguments={'executable': NODE}.items()),
        ]
    )

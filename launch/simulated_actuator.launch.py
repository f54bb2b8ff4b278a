# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Start an actuator without hardware: gear_simulator and gear_state_publisher."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description() -> LaunchDescription:
    """Declare the arguments, and start both nodes."""
    share = FindPackageShare('gear_kinematics')
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                'config',
                default_value=PathJoinSubstitution([share, 'config', 'simulated_actuator.yaml']),
                description='parameter file of both nodes',
            ),
            # It declares the other arguments, and checks the file.
            IncludeLaunchDescription(
                PathJoinSubstitution([share, 'launch', 'gear_state_publisher.launch.py'])
            ),
            Node(
                package='gear_kinematics',
                executable='gear_simulator',
                namespace=LaunchConfiguration('namespace'),
                parameters=[LaunchConfiguration('config')],
                remappings=[('rotor_state', LaunchConfiguration('rotor_state'))],
                output='screen',
            ),
        ]
    )

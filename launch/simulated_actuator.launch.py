# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Start an actuator without hardware: gear_simulator and gear_state_publisher."""

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, OpaqueFunction
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

from gear_kinematics.ros.launch_arguments import node_arguments
from gear_kinematics.twin.parameters import NODE


def start_simulator(context: LaunchContext) -> list[Node]:
    """Describe the simulator, with the arguments of the node beside it."""
    config, _, given = node_arguments(context.launch_configurations)
    texts = {name: ParameterValue(value, value_type=str) for name, value in given.items()}
    return [
        Node(
            package='gear_kinematics',
            executable='gear_simulator',
            name=NODE,
            namespace=LaunchConfiguration('namespace'),
            parameters=[config, texts] if texts else [config],
            remappings=[('rotor_state', LaunchConfiguration('rotor_state'))],
            output='screen',
        )
    ]


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
            OpaqueFunction(function=start_simulator),
        ]
    )

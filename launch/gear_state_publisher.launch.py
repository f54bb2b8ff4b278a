# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Start the gear state publisher."""

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

from gear_kinematics.parameters import NODE
from gear_kinematics.ros.launch_arguments import node_arguments


def start_node(context: LaunchContext) -> list[Node]:
    """Describe the node; what is not given as an argument is as in the parameter file.

    Another node that takes the same arguments is named as `executable` where this is included.
    """
    name = context.launch_configurations.get('executable', NODE)
    config, _, given = node_arguments(context.launch_configurations)
    # The type is stated, or a prefix like 1 would arrive as a number.
    texts = {name: ParameterValue(value, value_type=str) for name, value in given.items()}
    parameters = [config, texts] if texts else [config]
    return [
        Node(
            package='gear_kinematics',
            executable=name,
            # With a name, launch writes the prefix to the node's own block of parameters. In /**
            # it would be overridden by a block of the file for this node.
            name=name,
            namespace=LaunchConfiguration('namespace'),
            parameters=parameters,
            remappings=[('rotor_state', LaunchConfiguration('rotor_state'))],
            output='screen',
        )
    ]


def generate_launch_description() -> LaunchDescription:
    """Declare the arguments and start the node with them."""
    share = FindPackageShare('gear_kinematics')
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                'namespace', default_value='', description='namespace of the node'
            ),
            DeclareLaunchArgument(
                'config',
                default_value=PathJoinSubstitution([share, 'config', 'actuator.yaml']),
                description='parameter file of the node',
            ),
            DeclareLaunchArgument(
                'frame_prefix',
                default_value='',
                description='put before every frame id and joint name; '
                'if empty, that of the parameter file applies',
            ),
            DeclareLaunchArgument(
                'rotor_joint',
                default_value='',
                description='joint of the rotor in rotor_state; '
                'if empty, that of the parameter file applies',
            ),
            DeclareLaunchArgument(
                'rotor_state',
                default_value='rotor_state',
                description='topic of the rotor joint states',
            ),
            OpaqueFunction(function=start_node),
        ]
    )

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Show the mechanism: gear_state_publisher, robot_state_publisher and RViz."""

from pathlib import Path

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, OpaqueFunction
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackagePrefix, FindPackageShare

from gear_kinematics.parameters.arm import arm_urdf
from gear_kinematics.ros.launch_arguments import node_arguments, reads_description_topic


def check(context: LaunchContext) -> None:
    """Check the packages before anything starts: what has started would go on alone."""
    FindPackagePrefix('robot_state_publisher').perform(context)
    if IfCondition(LaunchConfiguration('rviz')).evaluate(context):
        FindPackagePrefix('rviz2').perform(context)


def start_viewers(context: LaunchContext) -> list[Node]:
    """Describe the nodes, with the parameters of gear_state_publisher."""
    actuators = node_arguments(context.launch_configurations).actuators
    mechanisms = [each for each in actuators.values() if not each.gear_ratio]
    first = (mechanisms or [*actuators.values()])[0]
    fixed_frame = 'base' if len(mechanisms) > 1 else f'{first.frame_prefix}stator'
    remappings = [('joint_states', 'mechanism_joint_states')]
    share = FindPackageShare('robot_state_publisher').perform(context)
    if reads_description_topic(Path(share)):
        description = {'use_robot_description_topic': True}
    else:
        description = {'robot_description': ParameterValue(arm_urdf(actuators)[0], value_type=str)}
        # It publishes the URDF again, which must not collide with the topic of the node.
        remappings.append(('robot_description', '~/robot_description'))
    return [
        Node(
            package='robot_state_publisher',
            executable='robot_state_publisher',
            namespace=LaunchConfiguration('namespace'),
            parameters=[
                {
                    **description,
                    'publish_frequency': ParameterValue(
                        LaunchConfiguration('publish_frequency'), value_type=float
                    ),
                }
            ],
            remappings=remappings,
            output='screen',
        ),
        Node(
            package='rviz2',
            executable='rviz2',
            namespace=LaunchConfiguration('namespace'),
            arguments=['-d', LaunchConfiguration('rviz_config'), '-f', fixed_frame],
            condition=IfCondition(LaunchConfiguration('rviz')),
            output='screen',
        ),
    ]


def generate_launch_description() -> LaunchDescription:
    """Declare the arguments, and start gear_state_publisher and the viewers."""
    share = FindPackageShare('gear_kinematics')
    return LaunchDescription(
        [
            DeclareLaunchArgument('rviz', default_value='true', description='whether to run RViz'),
            DeclareLaunchArgument(
                'rviz_config',
                default_value=PathJoinSubstitution([share, 'config', 'view.rviz']),
                description='saved configuration of RViz',
            ),
            DeclareLaunchArgument(
                'publish_frequency',
                default_value='60.0',  # frame rate in RViz's configuration
                description='highest rate of /tf, Hz',
            ),
            OpaqueFunction(function=check),
            # It declares the arguments of the node.
            IncludeLaunchDescription(
                PathJoinSubstitution([share, 'launch', 'gear_state_publisher.launch.py'])
            ),
            OpaqueFunction(function=start_viewers),
        ]
    )

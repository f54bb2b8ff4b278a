# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The topics of the nodes: the only place where their names and types are written.

Names are relative to the namespace of the node, unless they begin with a slash.
"""

from collections.abc import Mapping
from typing import Literal, NamedTuple

JOINT_STATE = 'sensor_msgs/msg/JointState'
POSE_ARRAY = 'geometry_msgs/msg/PoseArray'
WRENCHES = 'sensor_msgs/msg/MultiDOFJointState'

ROTOR_STATE = 'rotor_state'
OUTPUT_ENCODER = 'output_encoder'
OUTPUT_STATE = 'output_state'
BODY_POSES = 'body_poses'
JOINT_STATES = 'mechanism_joint_states'
CORRECTED_STATE = 'corrected_state'
CORRECTED_INTERVAL = 'corrected_interval'
TRANSMISSION_ERROR = 'transmission_error'
BRANCH_LOADS = 'branch_loads'
JOINT_LOADS = 'joint_loads'
REFERENCED = 'referenced'
ROBOT_DESCRIPTION = 'robot_description'
MARKERS = 'markers'
DIAGNOSTICS = '/diagnostics'

ROTOR_COMMAND = 'rotor_command'
LOAD_TORQUE = 'load_torque'


class NodeTopic(NamedTuple):
    """Type, part and publisher of a topic."""

    type: str
    part: Literal['input', 'state', 'correction', 'load', 'comparison', 'display', 'health']
    """A `state` is published for every valid rotor_state, a `correction` too if there is a
    calibration, a `load` if it has an effort, a `comparison` if there is an output_encoder, and
    a `display` only for subscribers."""
    publisher: Literal['driver', 'node']


TOPICS: Mapping[str, NodeTopic] = {
    ROTOR_STATE: NodeTopic(JOINT_STATE, 'input', 'driver'),
    OUTPUT_ENCODER: NodeTopic(JOINT_STATE, 'input', 'driver'),
    OUTPUT_STATE: NodeTopic(JOINT_STATE, 'state', 'node'),
    BODY_POSES: NodeTopic(POSE_ARRAY, 'state', 'node'),
    JOINT_STATES: NodeTopic(JOINT_STATE, 'state', 'node'),
    CORRECTED_STATE: NodeTopic(JOINT_STATE, 'correction', 'node'),
    CORRECTED_INTERVAL: NodeTopic(JOINT_STATE, 'correction', 'node'),
    TRANSMISSION_ERROR: NodeTopic(JOINT_STATE, 'comparison', 'node'),
    BRANCH_LOADS: NodeTopic(JOINT_STATE, 'load', 'node'),
    JOINT_LOADS: NodeTopic(WRENCHES, 'load', 'node'),
    ROBOT_DESCRIPTION: NodeTopic('std_msgs/msg/String', 'display', 'node'),
    MARKERS: NodeTopic('visualization_msgs/msg/MarkerArray', 'display', 'node'),
    REFERENCED: NodeTopic('std_msgs/msg/Bool', 'health', 'node'),
    DIAGNOSTICS: NodeTopic('diagnostic_msgs/msg/DiagnosticArray', 'health', 'node'),
}
"""All topics of gear_state_publisher by name."""


def _of_part(part: str) -> Mapping[str, str]:
    return {name: topic.type for name, topic in TOPICS.items() if topic.part == part}


STATE_TOPICS, LOAD_TOPICS, CORRECTED_TOPICS = map(_of_part, ('state', 'load', 'correction'))
"""The topics of the state, of the loads and of the corrected output, and their types."""


def topic_of(actuator: str, topic: str) -> str:
    """Return the name of a topic of an actuator, which may be that of all of an arm.

    A JointState has the joints of all; the actuator '' is the only one.
    """
    return f'{actuator}/{topic}' if actuator and TOPICS[topic].type != JOINT_STATE else topic


def base_name(topic: str) -> str:
    """Return the name of a topic without its namespace."""
    return topic.rpartition('/')[2]

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The ROS graph: which nodes are those of gears, and which topics those of drivers."""

from rclpy.node import Node
from rclpy.topic_endpoint_info import TopicEndpointInfo

from gear_kinematics.wire import topics

_TRIGGER = 'std_srvs/srv/Trigger'
_PUBLISHED = {
    name
    for name, topic in topics.TOPICS.items()
    if topic.publisher == 'node' and topic.type == topics.JOINT_STATE
}


def node_of(endpoint: TopicEndpointInfo) -> str:
    """Return the full name of the node of an endpoint."""
    return f'{endpoint.node_namespace.rstrip("/")}/{endpoint.node_name}'


class Graph:
    """The publishers of JointState topics, and the gear nodes, which have ~/home as well."""

    def __init__(self, node: Node) -> None:
        self._publishers = {
            topic: node.get_publishers_info_by_topic(topic)
            for topic, types in node.get_topic_names_and_types()
            if topics.JOINT_STATE in types
        }
        homes = {
            service.rpartition('/')[0]
            for service, types in node.get_service_names_and_types()
            if service.endswith('/home') and _TRIGGER in types
        }
        self.gears = sorted(name for name in homes if topics.OUTPUT_STATE in self.outputs_of(name))

    def outputs_of(self, gear: str) -> dict[str, str]:
        """Return the topics of a gear's node by the names that they have without remapping.

        A remapped `output_state` is recognised as the only unknown topic among known ones.
        """
        outputs = {
            topics.base_name(topic): topic
            for topic, publishers in self._publishers.items()
            if any(node_of(end) == gear for end in publishers)
        }
        unknown = outputs.keys() - _PUBLISHED
        if topics.OUTPUT_STATE not in outputs and len(unknown) == 1 < len(outputs):
            outputs[topics.OUTPUT_STATE] = outputs[unknown.pop()]
        return outputs

    def publishers_of(self, gear: str) -> set[bytes]:
        """Identify the publishers of a gear's `output_state`: a node that restarts has others."""
        topic = self.outputs_of(gear).get(topics.OUTPUT_STATE, '')
        ends = self._publishers.get(topic, ())
        return {bytes(end.endpoint_gid) for end in ends if node_of(end) == gear}

    def drivers(self) -> list[str]:
        """Find the topics that other nodes than those of gears publish."""
        return sorted(
            topic
            for topic, publishers in self._publishers.items()
            if any(node_of(end) not in self.gears for end in publishers)
        )

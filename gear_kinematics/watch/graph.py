# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What the ROS graph says: the nodes of gears, their topics, and the drivers beside them."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from typing import Any

from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node

from gear_kinematics.ros.diagnostics import full_name
from gear_kinematics.wire import topics

_TRIGGER = 'std_srvs/srv/Trigger'
_PUBLISHED = {
    name: topic.type for name, topic in topics.TOPICS.items() if topic.publisher == 'node'
}
_HEARD = {name: topic.type for name, topic in topics.TOPICS.items() if topic.publisher == 'driver'}
_OWN_STATES = {name for name, kind in _PUBLISHED.items() if kind == topics.JOINT_STATE}
_ENOUGH = 2  # names by which a node is known, however the others are remapped


def gear_nodes(node: Node) -> list[str]:
    """Find the full names of the nodes of gears: they have ~/home, and topics of known names."""
    running = {
        f'{namespace.rstrip("/")}/{name}'
        for name, namespace in node.get_node_names_and_namespaces()
    }
    owners = (
        service.rpartition('/')[0]
        for service, types in node.get_service_names_and_types()
        if service.endswith('/home') and _TRIGGER in types
    )
    return sorted(
        owner
        for owner in owners
        if owner in running
        and len({topics.base_name(name) for name in published_by(node, owner)} & _OWN_STATES)
        >= _ENOUGH
    )


def published_by(node: Node, name: str) -> dict[str, str]:
    """Return the topics that a node publishes, types by name; none if it does not run."""
    return _topics_of(name, node.get_publisher_names_and_types_by_node)


def outputs_of(node: Node, name: str) -> dict[str, str]:
    """Return the topics of a gear's node by the names that they have without remapping."""
    return known_as(_PUBLISHED, published_by(node, name))


def heard_by(node: Node, name: str) -> list[str]:
    """Return the topics of type JointState that a node hears."""
    heard = _topics_of(name, node.get_subscriber_names_and_types_by_node)
    return [topic for topic, kind in heard.items() if kind == topics.JOINT_STATE]


def inputs_of(heard: Iterable[str]) -> dict[str, str]:
    """Tell which of the topics that a gear's node hears is which, as `outputs_of` does."""
    return known_as(_HEARD, dict.fromkeys(heard, topics.JOINT_STATE))


def known_as(expected: Mapping[str, str], found: Mapping[str, str]) -> dict[str, str]:
    """Tell which topic is which, where some are remapped.

    From types by the name without remapping and by full name, returns full names by the former: of
    the same last part, and what is left if that is one of a type on either side.
    """
    relative = {topics.base_name(name): name for name in expected}
    known = {
        name: topic
        for topic, kind in found.items()
        if expected.get(name := relative.get(topics.base_name(topic), '')) == kind
    }
    for kind in set(expected.values()):
        missing = [name for name in expected if expected[name] == kind and name not in known]
        unknown = [
            topic for topic in found if found[topic] == kind and topic not in known.values()
        ]
        if len(missing) == len(unknown) == 1:
            known[missing[0]] = unknown[0]
    return known


def driver_topics(node: Node, gears: Iterable[str]) -> list[str]:
    """Find the topics of type JointState that somebody else than the nodes of gears publishes."""
    own = {topic for gear in gears for topic in published_by(node, gear)}
    return sorted(
        topic
        for topic, types in node.get_topic_names_and_types()
        if topics.JOINT_STATE in types and topic not in own and node.count_publishers(topic)
    )


def publishers_of(node: Node, topic: str, name: str) -> set[bytes]:
    """Identify the publishers that a node has on a topic: a node that restarts has others."""
    return {
        bytes(end.endpoint_gid)
        for end in node.get_publishers_info_by_topic(topic)
        if full_name(end) == name
    }


def _topics_of(name: str, ask: Callable[[str, str], Any]) -> dict[str, str]:
    namespace, _, base = name.rpartition('/')
    found: Sequence[tuple[str, list[str]]] = ()
    with suppress(rclpy_implementation.NodeNameNonExistentError):
        found = ask(base, namespace or '/')
    return {topic: types[0] for topic, types in found}

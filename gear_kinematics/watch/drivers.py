# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The ROS graph: the nodes of gears, and the drivers with their joints and rates."""

import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass

from rclpy.node import Node

from gear_kinematics.bag import Message
from gear_kinematics.ros.diagnostics import full_name
from gear_kinematics.ros.live import replay_node
from gear_kinematics.watch.polled import Polled
from gear_kinematics.wire import topics
from gear_kinematics.wire.cdr import MalformedMessageError, joint_names, joint_state_layout

_PERIOD = 0.1  # s between looks at graph and messages
_WAIT = 4.0  # s; a driver may find a listener only when it announces itself, every 3 s
_TRIGGER = 'std_srvs/srv/Trigger'
_PUBLISHED = {
    name
    for name, topic in topics.TOPICS.items()
    if topic.publisher == 'node' and topic.type == topics.JOINT_STATE
}


class Graph:
    """The publishers of JointState topics, and the gear nodes, which have ~/home as well."""

    def __init__(self, node: Node) -> None:
        """Query the graph."""
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
            if any(full_name(end) == gear for end in publishers)
        }
        unknown = outputs.keys() - _PUBLISHED
        if topics.OUTPUT_STATE not in outputs and len(unknown) == 1 < len(outputs):
            outputs[topics.OUTPUT_STATE] = outputs[unknown.pop()]
        return outputs

    def publishers_of(self, gear: str) -> set[bytes]:
        """Identify the publishers of a gear's `output_state`: a node that restarts has others."""
        topic = self.outputs_of(gear).get(topics.OUTPUT_STATE, '')
        ends = self._publishers.get(topic, ())
        return {bytes(end.endpoint_gid) for end in ends if full_name(end) == gear}

    def drivers(self) -> list[str]:
        """Find the topics that nodes other than those of gears publish."""
        return sorted(
            topic
            for topic, publishers in self._publishers.items()
            if any(full_name(end) not in self.gears for end in publishers)
        )


@dataclass(frozen=True, slots=True)
class DriverTopic:
    """A topic of type JointState that no gear node publishes."""

    topic: str
    joints: tuple[str, ...]  # as `rotor_joint` selects them; empty before the first message
    rate: float  # messages per second


class Listener:
    """Listens to topics of type JointState, to all messages or those that are wanted."""

    def __init__(self, node: Node, wanted: Callable[[bytes], bool] = bool) -> None:
        self._node, self._wanted = node, wanted
        self.heard: dict[str, Polled] = {}

    def look(self, found: Iterable[str]) -> None:
        """Subscribe to the topics that exist now."""
        found = set(found)
        for topic in self.heard.keys() - found:
            self.heard.pop(topic).close()
        for topic in found - self.heard.keys():
            self.heard[topic] = Polled(self._node, topic, wanted=self._wanted)

    def poll(self) -> list[Message]:
        """Take the messages that have arrived."""
        return [
            (topic, received, data)
            for topic, heard in self.heard.items()
            for data, received in heard.take()
        ]

    def drivers(self) -> list[DriverTopic]:
        """List the topics by name."""
        return [
            DriverTopic(topic, _joints(heard), heard.rate)
            for topic, heard in sorted(self.heard.items())
        ]


def _joints(heard: Polled) -> tuple[str, ...]:
    with suppress(MalformedMessageError):
        names = joint_names(joint_state_layout(heard.last.data)) if heard.last else ()
        return tuple(name.decode(errors='replace') for name in names)
    return ()


def listen(seconds: float = _WAIT) -> list[DriverTopic]:
    """Search for drivers for a number of seconds, and listen to them for as long again."""
    with replay_node('') as node:
        listener = Listener(node)
        found: list[DriverTopic] = []
        end = time.monotonic() + seconds
        while (now := time.monotonic()) < end or (
            now < end + seconds and not all(driver.joints for driver in found)
        ):
            listener.look(Graph(node).drivers())
            listener.poll()
            found = listener.drivers()
            time.sleep(_PERIOD)
        return found

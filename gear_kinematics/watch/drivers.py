# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The JointState topics of drivers: their joints, and how often they come."""

import time
from collections.abc import Collection
from contextlib import suppress
from dataclasses import dataclass

from rclpy.node import Node
from sensor_msgs.msg import JointState

from gear_kinematics.ros.live import replay_node
from gear_kinematics.watch.graph import driver_topics, gear_nodes
from gear_kinematics.watch.polled import Latest
from gear_kinematics.wire.cdr import MalformedMessageError, joint_names, joint_state_layout

_PERIOD = 0.1  # s between looks at graph and messages


@dataclass(frozen=True, slots=True)
class Driver:
    """A topic of type JointState that is not of a gear's node."""

    topic: str
    joints: tuple[str, ...]  # as `rotor_joint` selects them; empty before the first message
    rate: float  # messages per second
    publishers: int


class Drivers:
    """Listens to all JointState topics of drivers."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._latest: dict[str, Latest] = {}

    def look(self, gears: Collection[str]) -> None:
        """Subscribe to new topics; `gears` are the nodes whose topics are left out."""
        found = driver_topics(self._node, gears)
        for topic in self._latest.keys() - set(found):
            self._latest.pop(topic).close()
        for topic in found:
            if topic not in self._latest:
                self._latest[topic] = Latest(self._node, topic, JointState)

    def poll(self) -> None:
        """Take what has come."""
        for latest in self._latest.values():
            latest.poll()

    def latest(self, topic: str | None) -> Latest | None:
        """The latest message of a topic, if it is one of these."""
        return self._latest.get(topic or '')

    @property
    def all_heard(self) -> bool:
        """Whether a message has come of each topic."""
        return all(latest.last for latest in self._latest.values())

    def found(self) -> list[Driver]:
        """List the topics by name."""
        return [
            Driver(topic, _joints(latest), latest.rate, latest.publishers())
            for topic, latest in sorted(self._latest.items())
        ]


def _joints(latest: Latest) -> tuple[str, ...]:
    with suppress(MalformedMessageError):
        names = joint_names(joint_state_layout(latest.last.data)) if latest.last else ()
        return tuple(name.decode(errors='replace') for name in names)
    return ()


def listen(seconds: float) -> list[Driver]:
    """Find the drivers in a time of some seconds, and hear each in as many more."""
    with replay_node('') as node:
        drivers = Drivers(node)
        end = time.monotonic() + seconds
        while (now := time.monotonic()) < end or (now < end + seconds and not drivers.all_heard):
            drivers.look(gear_nodes(node))
            drivers.poll()
            time.sleep(_PERIOD)
        return drivers.found()

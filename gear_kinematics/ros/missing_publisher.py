# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Names the other topics of joint states while that of the rotor has no publisher."""

from rclpy.node import Node

from gear_kinematics.wire.nearest import listed
from gear_kinematics.wire.topics import JOINT_STATE, ROTOR_STATE


class MissingPublisher:
    """Warns once in each time without a publisher."""

    def __init__(self, node: Node) -> None:
        """Start with the node that subscribes to the rotor's topic."""
        self._node = node
        self._topic = node.resolve_topic_name(ROTOR_STATE)
        self._awaited = False
        """Whether there was none at the last update either."""
        self._warned = False

    def update(self, publishers: int) -> None:
        """Take the number of publishers on the rotor's topic; to be called once a second."""
        awaited, self._awaited = self._awaited, not publishers
        self._warned &= not publishers
        # At the first update, not all publishers are discovered yet.
        if publishers or self._warned or not awaited:
            return
        own = {self._topic, *(publisher.topic_name for publisher in self._node.publishers)}
        others = [
            name
            for name, types in self._node.get_topic_names_and_types()
            if JOINT_STATE in types and name not in own and self._node.count_publishers(name)
        ]
        if others:
            self._node.get_logger().warning(
                f'{self._topic} has no publisher; there are: {listed(others)}; choose one with '
                f'-r {ROTOR_STATE}:=<topic>, or with ros2 launch {ROTOR_STATE}:=<topic>'
            )
            self._warned = True

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Whether the nodes of other gears, which may share a topic, publish joints of the same names."""

from collections import Counter
from functools import partial

from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
from rclpy.task import Future

from gear_kinematics.wire.topics import OUTPUT_STATE

_NAMES = ['frame_prefix', 'output_joint']
_PATIENCE = 3  # questions, one a second, after which a node is no gear's, or does not answer


class OtherGears:
    """Asks other nodes how they name their joints."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._clients: dict[str, AsyncParameterClient] = {}
        self._asked: Counter[str] = Counter()
        self._names: dict[str, list[str]] = {}

    def clash(self, other: str, topic: str) -> bool:
        """Whether another node, by its full name, has joints of this one on a topic.

        False until it has had time to answer; True if it does not.
        """
        if other not in self._clients:
            try:
                self._clients[other] = AsyncParameterClient(self._node, other)
            except rclpy_implementation.RCLError:  # a policy of SROS 2 does not allow it
                return True
        client, self._asked[other] = self._clients[other], self._asked[other] + 1
        if client.services_are_ready():
            client.get_parameters(_NAMES, partial(self._take, other))
        if not (theirs := self._names.get(other)):
            return self._asked[other] > _PATIENCE
        ours = [self._node.get_parameter(name).value for name in _NAMES]
        return theirs == ours if topic == OUTPUT_STATE else theirs[0] == ours[0]

    def _take(self, other: str, answer: Future) -> None:
        names = [parameter_value_to_python(value) for value in answer.result().values]
        if len(names) == len(_NAMES) and None not in names:
            self._names[other] = names

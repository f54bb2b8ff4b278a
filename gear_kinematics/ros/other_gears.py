# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Nodes of other gears that share a topic, and whether they publish joints of the same names."""

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from operator import attrgetter

from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
from rclpy.task import Future

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.parameters.arm import full_name
from gear_kinematics.wire.topics import OUTPUT_STATE

_NAMES = ['frame_prefix', 'output_joint']
_PATIENCE = 3  # questions, one a second, after which a node is no gear's, or does not answer


class OtherGears:
    """Asks other nodes how they name their joints."""

    def __init__(self, node: Node, own: Callable[[], Iterable[NodeParameters]]) -> None:
        """Ask as a node; `own` returns the parameters of its actuators."""
        self._node, self._own = node, own
        self._clients: dict[str, AsyncParameterClient] = {}
        self._asked: Counter[str] = Counter()
        self._names: dict[str, list[NodeParameters]] = {}

    def clash(self, other: str, topic: str) -> bool:
        """Return whether another node has joints of this one on a topic, or does not answer."""
        if other not in self._clients:
            try:
                self._clients[other] = AsyncParameterClient(self._node, other)
            except rclpy_implementation.RCLError:  # a policy of SROS 2 does not allow it
                return True
        client, self._asked[other] = self._clients[other], self._asked[other] + 1
        if client.services_are_ready():
            self._ask(other, [''])
        if not (theirs := self._names.get(other)):
            return self._asked[other] > _PATIENCE
        key = attrgetter('output_name' if topic == OUTPUT_STATE else 'frame_prefix')
        return bool({*map(key, theirs)} & {*map(key, self._own())})

    def _ask(self, other: str, actuators: Sequence[str]) -> None:
        names = [full_name(actuator, name) for actuator in actuators for name in _NAMES]
        take = partial(self._take, other, actuators)
        self._clients[other].get_parameters(names, take)

    def _take(self, other: str, actuators: Sequence[str], answer: Future) -> None:
        names = [parameter_value_to_python(value) for value in answer.result().values]
        if names and None not in names:
            self._names[other] = [
                NodeParameters.of(dict(zip(_NAMES, pair, strict=True)), actuator)
                for actuator, *pair in zip(actuators, names[::2], names[1::2], strict=True)
            ]
        elif actuators == ['']:  # it could be an arm
            self._clients[other].get_parameters(['actuators'], partial(self._take_arm, other))

    def _take_arm(self, other: str, answer: Future) -> None:
        names = [parameter_value_to_python(value) for value in answer.result().values]
        if names and names[0]:
            self._ask(other, names[0])

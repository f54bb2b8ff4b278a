# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A node of a gear, as its topics and services show it."""

import math
import time
from collections.abc import Mapping
from functools import partial
from typing import Any, NamedTuple

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
from rclpy.task import Future
from std_srvs.srv import Trigger

from gear_kinematics.kinematics import Gear
from gear_kinematics.parameters import BRANCH_PARAMETERS, PARAMETERS, NodeParameters
from gear_kinematics.ros.diagnostics import full_name
from gear_kinematics.watch.drivers import Graph
from gear_kinematics.watch.polled import Polled
from gear_kinematics.wire import topics
from gear_kinematics.wire.joint_reader import JointReader, RejectedInputError

_PATIENCE = 2.0  # s: a service that has not found this client yet loses the request
_ZERO = 'rotor zero (rad)'  # in diagnostics
_SHOWN = topics.OUTPUT_STATE, *topics.CORRECTED_TOPICS, topics.TRANSMISSION_ERROR


class Joint(NamedTuple):
    """The only joint of the latest message of a topic."""

    position: float  # rad
    velocity: float | None  # rad/s
    age: float  # s since the message was received


class Status(NamedTuple):
    """One status of the diagnostics."""

    subject: str
    level: int
    message: str
    values: Mapping[str, str]
    at: float  # when it came; s of a steady clock


class GearNode:
    """Follows a node, by its full name, that may end and start again."""

    def __init__(self, node: Node, name: str) -> None:
        self._node = node  # subscribes and calls services
        self.name = name
        self.seen = False  # whether it has ever run
        self.running = False
        self.parameters: NodeParameters | None = None  # None until it has told them
        self.gear: Gear | None = None
        self.known = False  # whether it has told its parameters since it started
        self.fault = ''  # why these cannot be used
        self.earlier: dict[str, Any] = {}  # parameters before their last change that was seen
        self.homed_zero: float | None = None  # rotor_zero after its last change that was seen
        self.statuses: dict[str, Status] = {}  # diagnostics by subject
        self.home = node.create_client(Trigger, f'{name}/home')
        self._outputs: dict[str, Polled] = {}  # by names without remapping
        self._diagnostics = Polled(node, topics.DIAGNOSTICS, DiagnosticArray, raw=False)
        self._client = AsyncParameterClient(node, name)
        self._due = math.inf  # when to ask for the parameters; s of a steady clock
        self._publishers: set[bytes] = set()

    def look(self, graph: Graph) -> None:
        """See in the graph whether it runs, and which topics it has."""
        self.running = self.name in graph.gears
        if not self.running:
            return
        self.seen = True
        topics_now = graph.outputs_of(self.name)
        for name in _SHOWN:
            topic = topics_now.get(name, '')
            if name in self._outputs and self._outputs[name].topic != topic:
                self._outputs.pop(name).close()
            if topic and name not in self._outputs:
                self._outputs[name] = Polled(self._node, topic)
        publishers = graph.publishers_of(self.name)
        if publishers - self._publishers:
            self.statuses.clear()
            self.known = False
            self.reread()
        self._publishers = publishers

    def poll(self) -> None:
        """Take what has come."""
        for output in self._outputs.values():
            output.take()
        moved = False  # whether the zero has
        for message, _ in self._diagnostics.take():
            for status in message.status:
                if status.hardware_id == self.name:
                    subject = status.name.rpartition(': ')[2]
                    values = {pair.key: pair.value for pair in status.values}
                    if known := self.statuses.get(subject):
                        moved |= known.values.get(_ZERO) != values.get(_ZERO)
                    self.statuses[subject] = Status(
                        subject, status.level[0], status.message, values, time.monotonic()
                    )
        if moved:
            self.look(Graph(self._node))  # it may be another process by now
            self.reread()
        if self.running and time.monotonic() >= self._due and self._client.services_are_ready():
            self._due = time.monotonic() + _PATIENCE
            self._client.list_parameters([], 0, partial(self._ask, self._due))

    def joint(self, topic: str) -> Joint | None:
        """The latest value of one of the topics of `JointState`; None before there is one."""
        output = self._outputs.get(topic)
        if output is None or output.last is None:
            return None
        try:
            _, _, position, velocity, _ = JointReader('').read(output.last.data)
        except RejectedInputError:
            return None
        return Joint(position, velocity, output.age or 0.0)

    def hears(self, topic: str) -> bool:
        """Whether the node subscribes to a topic."""
        ends = self._node.get_subscriptions_info_by_topic(topic)
        return any(full_name(end) == self.name for end in ends)

    @property
    def rate(self) -> float:
        """Outputs per second: one for each input that can be used."""
        output = self._outputs.get(topics.OUTPUT_STATE)
        return output.rate if output else 0.0

    def reread(self) -> None:
        """Read the parameters once more."""
        self._due = 0.0

    def set(self, values: Mapping[str, Any]) -> Future:
        """Set all of some parameters, or none of them."""
        parameters = [Parameter(name, value=value) for name, value in values.items()]
        return self._client.set_parameters_atomically(parameters)

    def _ask(self, due: float, listed: Future) -> None:
        names = [
            name
            for name in listed.result().result.names
            if name in PARAMETERS or name.rpartition('.')[2] in BRANCH_PARAMETERS
        ]

        def take(answered: Future) -> None:
            values = answered.result().values
            # Else it has started again with other names, or has been asked once more.
            if len(values) == len(names) and self._due == due:
                values = map(parameter_value_to_python, values)
                self._take_parameters(dict(zip(names, values, strict=True)))

        self._client.get_parameters(names, take)

    def _take_parameters(self, given: Mapping[str, Any]) -> None:
        try:
            for name, value in given.items():
                known = PARAMETERS.get(name) or BRANCH_PARAMETERS[name.rpartition('.')[2]]
                if fault := known.fault(name, value):
                    raise ValueError(fault)
            parameters = NodeParameters.of(given)  # of which an older node can lack some
            self.gear = parameters.gear
        except ValueError as error:
            self.fault = str(error)
        else:
            self._follow(parameters)
            self.parameters, self.fault, self.known = parameters, '', True
            self._due = math.inf

    def _follow(self, parameters: NodeParameters) -> None:
        """See what has changed while the node ran."""
        if not (self.known and self.parameters):
            self.earlier = {}
            return
        before, now = self.parameters.values(), parameters.values()
        changed = {name: value for name, value in before.items() if now.get(name) != value}
        if changed:
            undone = self.earlier == {name: now[name] for name in changed}
            self.earlier = {} if undone else changed
        if 'rotor_zero' in changed:
            self.homed_zero = parameters.rotor_zero

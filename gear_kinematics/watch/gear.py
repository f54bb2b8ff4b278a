# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A node of a gear, as its topics and services show it."""

import math
import time
from collections.abc import Mapping
from typing import Any, NamedTuple

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
from rclpy.qos import ReliabilityPolicy
from rclpy.task import Future
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from gear_kinematics.kinematics import Gear
from gear_kinematics.parameters import BRANCH_PARAMETERS, PARAMETERS, NodeParameters
from gear_kinematics.watch import graph
from gear_kinematics.watch.polled import Latest, PolledSubscription
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
        self.running = False
        self.parameters: NodeParameters | None = None  # None until it has told them
        self.gear: Gear | None = None
        self.known = False  # whether it has told its parameters since it started
        self.fault = ''  # why these cannot be used
        self.restarts = -1  # how often it has been seen to start again
        self.earlier: dict[str, Any] = {}  # parameters before their last change that was seen
        self.homed_zero: float | None = None  # rotor_zero after its last change that was seen
        self.outputs: dict[str, str] = {}  # names of its topics by those without remapping
        self.heard: list[str] = []  # names of the topics that it hears
        self.inputs: dict[str, str] = {}  # those of them that are known, as in `outputs`
        self.statuses: dict[str, Status] = {}  # diagnostics by subject
        self.home = node.create_client(Trigger, f'{name}/home')
        self._latest: dict[str, Latest] = {}
        self._diagnostics: PolledSubscription | None = None
        self._client = AsyncParameterClient(node, name)
        self._asked: Future | None = None
        self._deadline = 0.0  # s of a steady clock, for the answer
        self._names: list[str] = []
        self._publishers: set[bytes] = set()

    def look(self) -> None:
        """See in the graph whether it runs, and which topics it has."""
        outputs = graph.outputs_of(self._node, self.name)
        self.running = topics.DIAGNOSTICS in outputs
        if not self.running:
            return
        self.heard = graph.heard_by(self._node, self.name)
        self.inputs = graph.inputs_of(self.heard)
        self._subscribe(outputs)
        publishers = graph.publishers_of(self._node, outputs[topics.DIAGNOSTICS], self.name)
        if publishers - self._publishers:
            self.restarts += 1
            self.statuses.clear()
            self.known = False
            self.reread()
        self._publishers = publishers

    def poll(self) -> None:
        """Take what has come."""
        for latest in self._latest.values():
            latest.poll()
        moved = False  # whether the zero has
        for taken in self._diagnostics.take() if self._diagnostics else ():
            for status in taken.data.status:
                if status.hardware_id == self.name:
                    subject = status.name.rpartition(': ')[2]
                    values = {pair.key: pair.value for pair in status.values}
                    if known := self.statuses.get(subject):
                        moved |= known.values.get(_ZERO) != values.get(_ZERO)
                    self.statuses[subject] = Status(
                        subject, status.level[0], status.message, values, time.monotonic()
                    )
        if moved:
            self.look()  # it may be another process by now
            self.reread()
        self._read_parameters()

    def joint(self, topic: str) -> Joint | None:
        """The latest value of one of the topics of `JointState`; None before there is one."""
        latest = self._latest.get(topic)
        if latest is None or latest.last is None:
            return None
        try:
            _, _, position, velocity, _ = JointReader('').read(latest.last.data)
        except RejectedInputError:
            return None
        return Joint(position, velocity, latest.age or 0.0)

    def reread(self) -> None:
        """Read the parameters once more."""
        self._names, self._asked, self._deadline = [], None, 0.0

    def set(self, values: Mapping[str, Any]) -> Future:
        """Set all of some parameters, or none of them."""
        parameters = [Parameter(name, value=value) for name, value in values.items()]
        return self._client.set_parameters_atomically(parameters)

    def _subscribe(self, outputs: dict[str, str]) -> None:
        for name in _SHOWN:
            topic = outputs.get(name, '')
            if name in self._latest and self._latest[name].topic != topic:
                self._latest.pop(name).close()
            if topic and name not in self._latest:
                self._latest[name] = Latest(self._node, topic, JointState)
        topic = outputs[topics.DIAGNOSTICS]
        if self._diagnostics and self._diagnostics.topic != topic:
            self._diagnostics.close()
            self._diagnostics = None
        if self._diagnostics is None:
            self._diagnostics = PolledSubscription(
                self._node, topic, DiagnosticArray, ReliabilityPolicy.BEST_EFFORT, raw=False
            )
        self.outputs = outputs

    def _read_parameters(self) -> None:
        """Take the next step: ask for the names, then for the values, again until they come."""
        if self._asked is not None and self._asked.done():
            answer, self._asked, self._deadline = self._asked.result(), None, 0.0
            if not self._names:
                self._names = [
                    name
                    for name in answer.result.names
                    if name in PARAMETERS or name.rpartition('.')[2] in BRANCH_PARAMETERS
                ]
            elif len(answer.values) == len(self._names):
                self._take_parameters(map(parameter_value_to_python, answer.values))
                return
            else:  # it has started again, with others
                self._names = []
        if self.running and time.monotonic() >= self._deadline:
            if not self._client.services_are_ready():
                return
            self._deadline = time.monotonic() + _PATIENCE
            names, client = self._names, self._client
            self._asked = client.get_parameters(names) if names else client.list_parameters([], 0)

    def _take_parameters(self, values: Any) -> None:
        given = dict(zip(self._names, values, strict=True))  # an older node can lack some
        self._names, self._deadline = [], time.monotonic() + _PATIENCE
        try:
            for name, value in given.items():
                known = PARAMETERS.get(name) or BRANCH_PARAMETERS[name.rpartition('.')[2]]
                if fault := known.fault(name, value):
                    raise ValueError(fault)
            parameters = NodeParameters.of(given)
            self.gear = parameters.gear
        except ValueError as error:
            self.fault = str(error)
        else:
            self._follow(parameters)
            self.parameters, self.fault, self.known = parameters, '', True
            self._deadline = math.inf

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

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The observed state of a gear node, from its topics and services."""

import math
import time
from collections.abc import Mapping
from concurrent import futures
from contextlib import suppress
from itertools import count
from operator import attrgetter
from typing import Any, NamedTuple, Self

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
from rclpy.serialization import deserialize_message
from rclpy.task import Future
from std_srvs.srv import Trigger

from gear_kinematics.parameters import BRANCH_PARAMETERS, PARAMETERS, NodeParameters
from gear_kinematics.parameters.arm import actuators_of, faults_in, full_name
from gear_kinematics.ros.graph import Graph, node_of
from gear_kinematics.watch.drivers import Listener
from gear_kinematics.watch.polled import Polled, Taken
from gear_kinematics.wire import topics
from gear_kinematics.wire.cdr import SECOND, MalformedMessageError
from gear_kinematics.wire.joint_reader import JointReader, RejectedInputError, joints_of
from gear_kinematics.wire.nearest import among

_PATIENCE = 2.0  # s: a service that has not found this client yet loses the request
_ZERO = 'rotor zero (rad)'  # in diagnostics
_MOST_SUBJECTS = 50  # of diagnostics; any node can send statuses under the name of another
_LONGEST = 1000  # characters of a text in diagnostics
_KNOWN = {name.rpartition('.')[2] for name in (*PARAMETERS, *BRANCH_PARAMETERS)}
"""Parameters without the names of actuators, branches and groups."""
_revisions = count(1)
_SHOWN = topics.OUTPUT_STATE, *topics.CORRECTED_TOPICS, topics.TRANSMISSION_ERROR


class JointValue(NamedTuple):
    """The single joint in the latest message of a topic."""

    position: float  # rad
    velocity: float | None  # rad/s
    age: float  # s since the message was received
    rate: float = 0.0  # messages per second


class Status(NamedTuple):
    """A status in the diagnostics."""

    subject: str
    level: int
    message: str
    values: Mapping[str, str]
    at: float  # when it came; s of a steady clock


class Answer(NamedTuple):
    """The result of a command."""

    text: str
    done: bool

    @classmethod
    def of(cls, response: Trigger.Response) -> Self:
        """Return the result of `~/home`."""
        return cls(f'{response.message}.', response.success)


def homing_client(node: Node, name: str, actuator: str) -> Any:
    """Return a client of `~/home` of the node with a full name, or of an actuator of it."""
    return node.create_client(Trigger, '/'.join(filter(None, (name, actuator, 'home'))))


def parameters_of(node: Node, name: str, *, runs: bool = False) -> Mapping[str, NodeParameters]:
    """Ask a gear's node for the parameters of its actuators; empty if it does not answer.

    One that `runs` is waited for until `node` has found it as well.
    """
    gear, end = GearNode(node, name), time.monotonic() + 2.0 * _PATIENCE
    with SingleThreadedExecutor(context=node.context) as executor:
        executor.add_node(node)
        while not gear.arm and time.monotonic() < end:
            graph = Graph(node)
            if name not in graph.gears and (not runs or gear.seen):
                break
            gear.look(graph, shown=False)
            gear.poll()
            executor.spin_once(timeout_sec=0.1)
    return gear.arm


class GearNode:
    """Follows a gear of the node with a full name, which may end and start again."""

    def __init__(self, node: Node, name: str, actuator: str = '') -> None:
        self._node = node  # subscribes and calls services
        self.name = name
        self.actuator = actuator  # of an arm; '': the first of what the node has
        self.arm: Mapping[str, NodeParameters] = {}  # of all actuators, once they are known
        self.seen = False  # whether it has ever run
        self.running = False
        self.revision = next(_revisions)  # repeated by commands; new after each start or change
        self.parameters: NodeParameters | None = None  # until it reports them after its start
        self.fault = ''  # why the reported parameters cannot be used
        self.earlier: dict[str, Any] = {}  # parameters before their last change that was seen
        self.homed_zero: float | None = None  # rotor_zero after its last change that was seen
        self.statuses: dict[str, Status] = {}  # diagnostics by subject
        self.homing = homing_client(node, name, actuator)
        self._topics: dict[str, str] = {}  # of what is shown, by names without remapping
        self._outputs = Listener(node, self._is_own)
        self._others: dict[tuple[str, ...], Taken] = {}
        """The latest messages of output_state with joints of other actuators alone, by these."""
        self._diagnostics = Polled(node, topics.DIAGNOSTICS, DiagnosticArray)
        self._client = AsyncParameterClient(node, name)
        self._due = math.inf  # when to ask for the parameters; s of a steady clock
        self._zero = ''  # in diagnostics
        self._publishers: set[bytes] = set()

    @property
    def label(self) -> str:
        """The full name of the node, and the name of the actuator if it has several."""
        return f'{self.name} {self.actuator}'.rstrip()

    def look(self, graph: Graph, *, shown: bool) -> None:
        """Find in the graph whether the node runs, and which topics it has, to be `shown`."""
        self.running = self.name in graph.gears
        if not self.running:
            return
        self.seen = True
        found = graph.outputs_of(self.name)
        self._topics = {name: found[name] for name in _SHOWN if name in found}
        self._outputs.look(self._topics.values() if shown else ())
        publishers = graph.publishers_of(self.name)
        if publishers - self._publishers:
            self.statuses.clear()
            self.parameters, self.fault, self.earlier, self.arm = None, '', {}, {}
            self._others.clear()
            self.revision, self._due = next(_revisions), 0.0
        self._publishers = publishers or self._publishers  # a busy machine loses sight of them

    def poll(self) -> None:
        """Take the messages that have arrived."""
        self._outputs.poll()
        for data, *_ in self._diagnostics.take():
            for status in deserialize_message(data, DiagnosticArray).status:
                prefix, whole = self.actuator and f'{self.actuator}: ', status.name.partition(': ')
                if status.hardware_id == self.name and whole[2].startswith(prefix):
                    subject = whole[2].removeprefix(prefix)[:_LONGEST]
                    values = {pair.key: pair.value[:_LONGEST] for pair in status.values}
                    if (zero := values.get(_ZERO, self._zero)) != self._zero:
                        self._zero = zero
                        # It may be another process by now.
                        self.look(Graph(self._node), shown=bool(self._outputs.heard))
                        self._due = 0.0
                    message, at = status.message[:_LONGEST], time.monotonic()
                    self.statuses.pop(subject, None)  # the first is the oldest
                    self.statuses[subject] = Status(subject, status.level[0], message, values, at)
                    while len(self.statuses) > _MOST_SUBJECTS:
                        self.statuses.pop(next(iter(self.statuses)))
        if self.running and time.monotonic() >= self._due and self._client.services_are_ready():
            self._due = time.monotonic() + _PATIENCE
            self._client.list_parameters([], 0, self._ask)

    def joint(self, topic: str, name: str = '') -> JointValue | None:
        """Return the latest value of the output's joint on a topic, or of a named one, if any."""
        output = self._outputs.heard.get(self._topics.get(topic, ''))
        if output is None or output.last is None:
            return None
        own = self.parameters.output_name if self.parameters else ''
        heard = output.last, *(self._others.values() if name else ())
        for taken in sorted(heard, key=attrgetter('received'), reverse=True):
            with suppress(RejectedInputError):
                _, _, position, velocity, _ = JointReader(name or own).read(taken.data)
                age = (time.time_ns() - taken.received) / SECOND
                return JointValue(position, velocity, age, output.rate)
        return None

    def _is_own(self, topic: str, data: bytes) -> bool:
        """Return whether a message has the output's joint: other gears may share the topic."""
        if not (parameters := self.parameters):
            return True
        with suppress(MalformedMessageError):
            joints = tuple(joints_of(data))
            if parameters.output_name in joints:
                return True
            known = len(self._others) < len(self.arm) or joints in self._others
            if known and topic == self._topics.get(topics.OUTPUT_STATE):
                self._others[joints] = Taken(data, time.time_ns(), 0)
        return False

    def hears(self, topic: str) -> bool:
        """Return whether the node subscribes to a topic."""
        ends = self._node.get_subscriptions_info_by_topic(topic)
        return any(node_of(end) == self.name for end in ends)

    def home(self, answer: 'futures.Future[Answer]') -> None:
        """Call `~/home`, and answer with its response."""

        def take(answered: Future) -> None:
            answer.set_result(Answer.of(answered.result()))
            self._due = 0.0

        self.homing.call_async(Trigger.Request()).add_done_callback(take)

    def set(self, values: Mapping[str, Any], done: str, answer: 'futures.Future[Answer]') -> None:
        """Set parameters unless someone else has changed them; answer with success or a reason."""

        def check(answered: Future) -> None:
            present = self.parameters.values() if self.parameters else {}
            if _values(answered) == [present.get(name) for name in values]:
                self._client.set_parameters_atomically(parameters, take)
            else:
                self._due = 0.0
                answer.set_result(Answer('Nothing was done: the node has changed.', done=False))

        def take(answered: Future) -> None:
            result = answered.result().result
            text = done if result.successful else f'{result.reason}.'
            answer.set_result(Answer(text, result.successful))
            self._due = 0.0

        parameters = [
            Parameter(full_name(self.actuator, name), value=value)
            for name, value in values.items()
        ]
        self._client.get_parameters([each.name for each in parameters], check)

    def _ask(self, listed: Future) -> None:
        names = [n for n in listed.result().result.names if n.rpartition('.')[2] in _KNOWN]

        def take(answered: Future) -> None:
            values = _values(answered)
            if len(values) == len(names):  # else it has started again with other names
                self._take_parameters(dict(zip(names, values, strict=True)))

        self._client.get_parameters(names, take)

    def _take_parameters(self, given: Mapping[str, Any]) -> None:
        """Take the parameters, and note what has changed while the node ran."""
        try:
            if faults := faults_in(given):
                raise ValueError('; '.join(faults))
            self.arm = arm = actuators_of(given)  # of whose values an older node can lack some
            if (actuator := self.actuator or next(iter(arm))) not in arm:
                raise ValueError(f'it has no actuator {actuator!r}{among(actuator, arm)}')
            parameters = arm[actuator]
            _ = parameters.gear
        except ValueError as error:
            self.fault = str(error)
            return
        if actuator != self.actuator:
            self.statuses.clear()  # they were those of all actuators
            self._node.destroy_client(self.homing)
            self.actuator, self.homing = actuator, homing_client(self._node, self.name, actuator)
        if self.parameters:
            now, before = parameters.values(), self.parameters.values()
            changed = {name: value for name, value in before.items() if now.get(name) != value}
            if changed:
                self.earlier, self.revision = changed, next(_revisions)
            if 'rotor_zero' in changed:
                self.homed_zero = parameters.rotor_zero
        self.parameters, self.fault, self._due = parameters, '', math.inf


def _values(answered: Future) -> list[Any]:
    """Return parameters; ROS drops the type of an empty list, as `actuators: []` in a file."""
    values = [parameter_value_to_python(each) for each in answered.result().values]
    return [[] if each is None else each for each in values]

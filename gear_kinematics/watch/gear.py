"""A node of a gear, as its topics and services show it."""

import math
import time
from collections.abc import Mapping
from typing import Any, NamedTuple

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python
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
_SHOWN = (
    topics.OUTPUT_STATE,
    topics.CORRECTED_STATE,
    topics.CORRECTED_INTERVAL,
    topics.TRANSMISSION_ERROR,
)


class Joint(NamedTuple):
    """The only joint of the latest message of a topic."""

    position: float
    """rad."""
    velocity: float | None
    """rad/s."""
    age: float
    """s since the message was received."""


class Status(NamedTuple):
    """One status of the diagnostics."""

    subject: str
    level: int
    message: str
    values: Mapping[str, str]
    at: float
    """When it came; s of a steady clock."""


class GearNode:
    """Follows a node that may end and start again."""

    def __init__(self, node: Node, name: str) -> None:
        """Begin to follow.

        Args:
            node: subscribes and calls services.
            name: full name of the node of the gear.
        """
        self._node = node
        self.name = name
        self.running = False
        self.parameters: NodeParameters | None = None
        """Of the node; None until it has told them."""
        self.gear: Gear | None = None
        self.known = False
        """Whether the node has told its parameters since it started."""
        self.restarts = -1
        """How often it has been seen to start again."""
        self.outputs: dict[str, str] = {}
        """Names of its topics by those without remapping."""
        self.heard: list[str] = []
        """Names of the topics that it hears."""
        self.inputs: dict[str, str] = {}
        """Those of them that are known, as in `outputs`."""
        self.statuses: dict[str, Status] = {}
        """Diagnostics by subject."""
        self.home = node.create_client(Trigger, f'{name}/home')
        self._latest: dict[str, Latest] = {}
        self._diagnostics: PolledSubscription | None = None
        self._client = AsyncParameterClient(node, name)
        self._asked: Future | None = None
        self._deadline = 0.0  # s of a steady clock, for the answer
        self._names: list[str] = []
        self._publishers: set[bytes] = set()
        self._readers: dict[str, JointReader] = {}

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
        for taken in self._diagnostics.take() if self._diagnostics else ():
            for status in taken.data.status:
                if status.hardware_id == self.name:
                    subject = status.name.rpartition(': ')[2]
                    values = {pair.key: pair.value for pair in status.values}
                    self.statuses[subject] = Status(
                        subject, status.level[0], status.message, values, time.monotonic()
                    )
        self._read_parameters()

    def joint(self, topic: str) -> Joint | None:
        """The latest value of one of the topics of `JointState`; None before there is one."""
        latest = self._latest.get(topic)
        if latest is None or latest.last is None:
            return None
        try:
            reader = self._readers.setdefault(topic, JointReader(''))
            _, _, position, velocity, _ = reader.read(latest.last.data)
        except RejectedInputError:
            return None
        return Joint(position, velocity, latest.age or 0.0)

    def reread(self) -> None:
        """Read the parameters once more."""
        self._names, self._asked, self._deadline = [], None, 0.0

    def _subscribe(self, outputs: dict[str, str]) -> None:
        for name in _SHOWN:
            topic, latest = outputs.get(name), self._latest.get(name)
            if latest and latest.topic != topic:
                self._latest.pop(name).close()
            if topic and name not in self._latest:
                self._latest[name] = Latest(self._node, topic, JointState)
        topic = outputs[topics.DIAGNOSTICS]
        if self._diagnostics is None or self._diagnostics.topic != topic:
            if self._diagnostics:
                self._diagnostics.close()
            self._diagnostics = PolledSubscription(
                self._node, topic, DiagnosticArray, ReliabilityPolicy.BEST_EFFORT, raw=False
            )
        self.outputs = outputs

    def _read_parameters(self) -> None:
        """Take the next step: ask for the names, then for the values, again until they come."""
        if self._asked is not None and self._asked.done():
            answer, self._asked = self._asked.result(), None
            self._deadline = 0.0
            if not self._names:
                self._names = [name for name in answer.result.names if _is_ours(name)]
            elif len(answer.values) == len(self._names):
                self._take_parameters(map(parameter_value_to_python, answer.values))
                return
            else:  # it has started again, with others
                self._names = []
        if self.running and time.monotonic() >= self._deadline:
            if not self._client.services_are_ready():
                return
            self._deadline = time.monotonic() + _PATIENCE
            self._asked = (
                self._client.get_parameters(self._names)
                if self._names
                else self._client.list_parameters([], 0)
            )

    def _take_parameters(self, values: Any) -> None:
        # An older version of the node can lack some.
        self.parameters = NodeParameters.of(dict(zip(self._names, values, strict=True)))
        self.gear = self.parameters.gear
        self.known, self._deadline = True, math.inf


def _is_ours(name: str) -> bool:
    return name in PARAMETERS or name.rpartition('.')[2] in BRANCH_PARAMETERS

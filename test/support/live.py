# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A driver, listener and client beside a live gear_state_publisher, and messages to send to it."""

import itertools
import json
import math
import os
import re
import struct
import time
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseArray
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.signals import SignalHandlerOptions
from rclpy.subscription import Subscription
from replaying import SECOND, TYPESTORE, encode, stamp_of
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from std_srvs.srv import Trigger

from gear_kinematics.ros.live import running_node
from gear_kinematics.ros.workarounds.shutdown import shut_down

DEADLINE = 60.0  # s: far beyond anything but a failure
START = 100 * SECOND
STATES = ('output_state', 'body_poses', 'mechanism_joint_states')
PATIENT = '-p', 'input_timeout:=1000.0'
"""Arguments of a node whose driver may fall silent, as every one does on a busy machine."""
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)

_namespaces = (f'/live_{os.getpid()}_{number}' for number in itertools.count())


class LogLine(NamedTuple):
    level: str
    time: float
    text: str


def parameter(name, value) -> tuple[str, str]:
    """Return the arguments of a node that set a parameter."""
    return '-p', f'{name}:={json.dumps(value)}'


def rotor_state(stamp, names=('rotor',), position=(), velocity=(), effort=(), frame_id=''):
    """Make the message; the stamp in ns."""
    message = JointState(
        name=list(names), position=list(position), velocity=list(velocity), effort=list(effort)
    )
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
    message.header.frame_id = frame_id
    return message


def rotor_bytes(
    stamp,
    names=('rotor',),
    position=(),
    velocity=(),
    effort=(),
    frame_id='',
    *,
    little_endian=True,
) -> bytes:
    """Serialise the message as rosbags does, which is neither ROS nor the code under test."""
    arrays = position, velocity, effort
    data, places = _layout(tuple(names), tuple(map(len, arrays)), frame_id, little_endian)
    made, order = bytearray(data), '<' if little_endian else '>'
    struct.pack_into(f'{order}iI', made, 4, *divmod(stamp, SECOND))
    for place, values in zip(places, filter(len, arrays), strict=True):
        struct.pack_into(f'{order}{len(values)}d', made, place, *values)
    return bytes(made)


@cache
def _layout(names, counts, frame_id, little_endian) -> tuple[bytes, list[int]]:
    """Serialise a message with rosbags, and find where the numbers of each array begin."""
    types = TYPESTORE.types
    arrays = [math.pi * (k + 1) + np.arange(count) for k, count in enumerate(counts)]
    header = types['std_msgs/msg/Header'](types['builtin_interfaces/msg/Time'](0, 0), frame_id)
    message = types['sensor_msgs/msg/JointState'](header, list(names), *arrays)
    data = encode(message, little_endian=little_endian)
    kind = f'{"<" if little_endian else ">"}f8'
    return data, [data.index(array.astype(kind).tobytes()) for array in arrays if len(array)]


class Participant:
    """A node in a context of its own. Messages arrive only within the waits."""

    def __init__(self, name: str, namespace: str = '') -> None:
        self.alive = lambda: True
        context = Context()
        rclpy.init(context=context, signal_handler_options=SignalHandlerOptions.NO)
        self.node = Node(name, context=context, namespace=namespace)
        self._executor = SingleThreadedExecutor(context=context)
        self._executor.add_node(self.node)

    def close(self) -> None:
        """Leave."""
        self._executor.shutdown()
        shut_down(self.node)

    def wait_until(self, condition, what: str):
        """Receive until a condition holds, and return what it gave."""
        deadline = time.monotonic() + DEADLINE
        while not (result := condition()):
            assert self.alive(), f'the node ended before {what}'
            assert time.monotonic() < deadline, f'waited in vain for {what}'
            self._executor.spin_once(timeout_sec=0.02)
        return result

    def answer_to(self, call):
        """Call a service until it answers.

        A service discovers the request and the answer of a client one by one: it loses a request,
        or has nowhere to send its answer, though the client already takes it for ready.
        """
        future, until = None, 0.0

        def answered():
            nonlocal future, until
            if time.monotonic() > until:
                future = call()
                until = time.monotonic() + 5.0
            return future.done()

        self.wait_until(answered, 'an answer')
        return future.result()

    def parameters_of(self, client: AsyncParameterClient, *names: str) -> list:
        """Get the values of a node's parameters."""
        self.wait_until(client.services_are_ready, 'the parameter services')
        values = self.answer_to(lambda: client.get_parameters(list(names))).values
        return [rclpy.parameter.parameter_value_to_python(value) for value in values]


class Listener(Participant):
    """Keeps the node's outputs."""

    def __init__(self, namespace: str, name: str = 'listener', **topics: str) -> None:
        """Open the topics; `topics` gives those that are not at their usual place."""
        super().__init__(name, namespace)
        self.received: dict[str, list] = {}
        self.namespace = namespace
        self._subscriptions = [
            self.listen(message_type, topic, QoSProfile(depth=2000), topics.get(topic, topic))
            for topic, message_type in zip(
                STATES, (JointState, PoseArray, JointState), strict=True
            )
        ]

    def listen(self, message_type, name, qos, topic=None) -> Subscription:
        """Keep what comes on a topic in `received[name]`."""
        messages = self.received.setdefault(name, [])
        return self.node.create_subscription(message_type, topic or name, messages.append, qos)

    def receive(self) -> None:
        """Receive a message if there is one."""
        self._executor.spin_once(timeout_sec=0.0)


class Peer(Listener):
    """The other end of a node under test: its driver, listener and client."""

    def __init__(self, namespace: str, **topics: str) -> None:
        """Open the topics; `topics` gives those that are not at their usual place."""
        super().__init__(namespace, 'peer', **topics)
        self._stamps = itertools.count(START, SECOND // 1000)
        qos = QoSProfile(depth=2000)
        self._driver = self.node.create_publisher(
            JointState, topics.get('rotor_state', 'rotor_state'), qos
        )
        self._reports: list[tuple[int, DiagnosticArray]] = []  # with the time of publication, ns
        self.node.create_subscription(
            DiagnosticArray, topics.get('diagnostics', '/diagnostics'), self._keep_report, qos
        )
        self._parameters = AsyncParameterClient(self.node, f'{namespace}/gear_state_publisher')

    def connect(self, *, probes=True, joint='rotor') -> None:
        """Wait until the node receives from the driver, and this peer receives its outputs.

        Publishers and subscriptions discover each other one by one, so a count of endpoints at
        one end says nothing of the other end: probes are sent, with stamps from 1 ns on.
        """
        self.wait_until(self._driver.get_subscription_count, 'a subscription to rotor_state')
        if not probes:
            return
        for number in itertools.count(1):
            self.send(rotor_state(number, [joint], [0.0]))
            until = time.monotonic() + 0.1 * number
            self.wait_until(
                lambda n=number, t=until: self._heard(n) or time.monotonic() > t, 'a probe'
            )
            if self._heard(number):
                break
        for name in STATES:
            self.received[name].clear()

    def driver(self, topic: str, depth: int = 2000):
        """Create a driver that is connected to the node, with a history of `depth` messages."""
        driver = self.node.create_publisher(JointState, topic, QoSProfile(depth=depth))
        self.wait_until(driver.get_subscription_count, f'a subscription to {topic}')
        return driver

    def _heard(self, stamp: int) -> bool:
        return all(
            any(stamp_of(message) == stamp for message in self.received[name]) for name in STATES
        )

    def stamp(self) -> int:
        """Return the stamp of the next message, a millisecond after the last."""
        return next(self._stamps)

    def send(self, *messages) -> None:
        """Send messages or their bytes on rotor_state."""
        for message in messages:
            self._driver.publish(message)

    def outputs(self, count: int) -> list[tuple]:
        """Wait for a number of outputs and take them: output_state, body_poses, joint states."""
        self.wait_until(
            lambda: all(len(self.received[name]) >= count for name in STATES), f'{count} outputs'
        )
        outputs = list(zip(*(self.received[name] for name in STATES), strict=True))
        assert len(outputs) == count
        for name in STATES:
            self.received[name].clear()
        return outputs

    def answer(self, *messages) -> tuple:
        """Send messages, of which only the last may be answered, and take the answer."""
        self.send(*messages)
        [output] = self.outputs(1)
        assert all(stamp_of(message) == stamp_of(messages[-1]) for message in output)
        return output

    def report(self, condition=bool, what='diagnostics', meanwhile=lambda: None, since=None):
        """Wait for the first report on this peer's node whose status meets a condition.

        `meanwhile` is called repeatedly. The report was published after `since`, ns, by default
        now, as one that is still on its way is about what was before.
        """
        name = f'{self.namespace}/gear_state_publisher'
        since = since or time.time_ns()

        def found():
            meanwhile()
            matching = (
                (message, status)
                for published, message in self._reports
                if published > since
                for status in message.status
                if status.hardware_id == name and condition(status)
            )
            return next(matching, None)

        return self.wait_until(found, what)

    def status(self, *arguments, **options):
        """Wait for a report in the same way; returns level, message and values of its status."""
        _, status = self.report(*arguments, **options)
        values = {pair.key: pair.value for pair in status.values}
        return status.level[0], status.message, values

    def endpoints(self, found, topic):
        """Wait until the graph knows the node's endpoints on a topic, and take their qualities."""

        def known():
            return [
                info.qos_profile
                for info in found(topic)
                if (info.node_name, info.node_namespace)
                == ('gear_state_publisher', self.namespace)
            ]

        return self.wait_until(known, f'the endpoints of {topic}')

    def home(self):
        """Call ~/home."""
        client = self.node.create_client(Trigger, 'gear_state_publisher/home')
        self.wait_until(client.service_is_ready, '~/home')
        return self.answer_to(lambda: client.call_async(Trigger.Request()))

    def set(self, **values):
        """Set parameters through the service, one by one; returns the result of the last."""
        self.wait_until(self._parameters.services_are_ready, 'the parameter services')
        parameters = [Parameter(name, value=value) for name, value in values.items()]
        return self.answer_to(lambda: self._parameters.set_parameters(parameters)).results[-1]

    def get(self, *names) -> list:
        """Get the values of parameters through the service."""
        return self.parameters_of(self._parameters, *names)

    def description(self) -> str:
        """Listen to robot_description from now on and take what was latched."""
        name = f'robot_description {len(self.received)}'
        self.listen(String, name, LATCHED, 'robot_description')
        return self.wait_until(lambda: self.received[name], 'robot_description')[-1].data

    def _keep_report(self, message, about) -> None:
        self._reports.append((about['source_timestamp'], message))


class Live(NamedTuple):
    """A node under test as a process of its own, and a peer in its namespace."""

    peer: Peer
    process: object
    log: Path

    def text(self) -> str:
        """Return what the process has written."""
        return self.log.read_text(encoding='utf-8')

    def lines(self, level: str = '') -> list[LogLine]:
        """Return the log lines of a level so far."""
        found = re.findall(r'^\[(\w+)\] \[([\d.]+)\] \[[^\]]*\]: (.*)$', self.text(), re.MULTILINE)
        lines = (LogLine(name, float(moment), text) for name, moment, text in found)
        return [line for line in lines if line.level == level or not level]


@contextmanager
def live_node(folder: Path, *arguments: str, namespace: str = '', **topics: str):
    """Run the node and a peer; in the end the node has exit code 0 and shows no traceback."""
    namespace = namespace or next(_namespaces)
    log = folder / f'{namespace.strip("/").replace("/", "_")}.log'
    command = ['--ros-args', '-r', f'__ns:={namespace}', *arguments]
    peer = Peer(namespace, **topics)
    environment = {**os.environ, 'ROS_LOG_DIR': str(folder)}
    try:
        with (
            log.open('w', encoding='utf-8') as stream,
            running_node(command, stdout=stream, stderr=stream, env=environment) as process,
        ):
            live = Live(peer, process, log)
            peer.alive = lambda: process.poll() is None
            yield live
        assert process.returncode == 0, live.text()
        assert 'Traceback' not in live.text(), live.text()
    finally:
        peer.close()


@contextmanager
def connected(folder: Path, *arguments: str, namespace: str = ''):
    """Run the node and yield a peer that is connected with it."""
    with live_node(folder, *arguments, namespace=namespace) as live:
        live.peer.connect()
        yield live.peer

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A driver and a listener as processes of their own, on any host: Fast DDS has one per process."""

import math
import multiprocessing
import struct
import time
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing.managers import BaseManager
from threading import Event, Thread
from typing import Any, NamedTuple

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseArray
from live import DEADLINE, SECOND, START, rotor_bytes, stamp_of
from rcl_interfaces.srv import GetParameters
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from gear_kinematics.ros.workarounds.shutdown import shut_down

PERIOD = SECOND // 100  # ns
STEP = 0.3  # rad within the period
BEGIN = 0.1  # rad: not the zero of a node that nobody has homed, so that homing changes it
OUTPUTS = {'output_state': JointState, 'body_poses': PoseArray}


class Line(NamedTuple):
    """From the driver through a node to a listener, in a ROS namespace of its own."""

    reliability: str
    depth: int
    """Messages that the driver keeps for the node."""
    encoder: str


class Report(NamedTuple):
    """What a node says in its diagnostics."""

    stamp: int
    message: str
    values: dict[str, str]


def reading(number: int, encoder: str) -> float:
    """Return the position in the driver's message of this number. The rotor turns steadily."""
    angle = BEGIN + STEP * number
    return math.remainder(angle, math.tau) if encoder == 'single_turn' else angle


def rotor_message(number: int, encoder: str) -> bytes:
    """Return the driver's message of this number."""
    return rotor_bytes(START + number * PERIOD, position=[reading(number, encoder)])


def number_of(output: bytes) -> int:
    """Return the number of the driver's message with the stamp that an output begins with."""
    seconds, nanoseconds = struct.unpack_from('<iI', output, 4)
    return (seconds * SECOND + nanoseconds - START) // PERIOD


class Endpoint:
    """A participant in ROS."""

    def __init__(self, name: str) -> None:
        rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
        self._node = Node(name)

    def close(self) -> None:
        shut_down(self._node)


class Driver(Endpoint):
    """Drives every line at once. After a pause the stamps go on from where they stopped."""

    def __init__(self, lines: dict[str, Line]) -> None:
        super().__init__('driver')
        self._publishers = []
        for name, line in lines.items():
            reliability = ReliabilityPolicy[line.reliability]
            qos = QoSProfile(depth=line.depth, reliability=reliability)
            publisher = self._node.create_publisher(JointState, f'/{name}/rotor_state', qos)
            self._publishers.append((publisher, line.encoder))
        self._sent = 0
        self._paused = Event()
        self._thread = Thread()

    def drive(self) -> None:
        self._paused.clear()
        self._thread = Thread(target=self._publish)
        self._thread.start()

    def pause(self) -> int:
        self._paused.set()
        self._thread.join()
        return self._sent

    def sent(self) -> int:
        return self._sent

    def close(self) -> None:
        self.pause()
        super().close()

    def _publish(self) -> None:
        due = time.monotonic()
        while not self._paused.wait(max(0.0, due - time.monotonic())):
            for publisher, encoder in self._publishers:
                publisher.publish(rotor_message(self._sent, encoder))
            self._sent += 1
            # What is late is not made up for in a burst, which sockets have no room for.
            due = max(due, time.monotonic()) + PERIOD / SECOND


class Listener(Endpoint):
    """Keeps what the node of a line publishes, and calls its service."""

    def __init__(self, name: str) -> None:
        super().__init__('listener')
        qos = QoSProfile(depth=2000)
        node_name = f'/{name}/gear_state_publisher'
        self._outputs: dict[str, list[bytes]] = {topic: [] for topic in OUTPUTS}
        self._report: Report | None = None

        def keep_report(message: DiagnosticArray) -> None:
            [status] = message.status
            if status.hardware_id == node_name:
                values = {pair.key: pair.value for pair in status.values}
                self._report = Report(stamp_of(message), status.message, values)

        for topic, kind in OUTPUTS.items():
            keep = self._outputs[topic].append
            self._node.create_subscription(kind, f'/{name}/{topic}', keep, qos, raw=True)
        self._node.create_subscription(DiagnosticArray, '/diagnostics', keep_report, qos)
        self._homing = self._node.create_client(Trigger, f'{node_name}/home')
        self._asking = self._node.create_client(GetParameters, f'{node_name}/get_parameters')
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)
        self._thread = Thread(target=self._executor.spin)
        self._thread.start()

    def newest(self) -> int:
        """Return the number of the newest message that is answered on every topic, or -1."""
        return min(number_of(data[-1]) if data else -1 for data in self._outputs.values())

    def outputs(self, first: int) -> list[list[bytes]]:
        """Return the answers on every topic from that to the driver's `first` on."""
        return [
            [data for data in messages if number_of(data) >= first]
            for messages in self._outputs.values()
        ]

    def report(self) -> Report | None:
        """Return the node's newest report."""
        return self._report

    def home(self) -> float:
        """Home the node and give its new zero, rad."""
        before = self._zero()
        until = time.monotonic() + DEADLINE
        while (zero := self._zero()) == before:  # also if the request or its answer is lost
            assert time.monotonic() < until, f'the zero is still {before}'
            answer = self._answer(self._homing, Trigger.Request())
            assert not answer or answer.success, answer.message
        return zero

    def _zero(self) -> float:
        request, answer = GetParameters.Request(names=['rotor_zero']), None
        until = time.monotonic() + DEADLINE
        while not answer:
            assert time.monotonic() < until, 'the node does not tell its zero'
            answer = self._answer(self._asking, request)
        return answer.values[0].double_value

    @staticmethod
    def _answer(client, request):
        """Call a service once; None if it has not answered after a while."""
        assert client.wait_for_service(DEADLINE)
        answered, future = Event(), client.call_async(request)
        future.add_done_callback(lambda _: answered.set())
        return future.result() if answered.wait(5.0) else None

    def close(self) -> None:
        self._executor.shutdown()
        self._thread.join()
        super().close()


class Process(BaseManager):
    """A process in which an endpoint is."""


for _kind in (Driver, Listener):
    Process.register(_kind.__name__, _kind)


@contextmanager
def running(kind: type[Endpoint], argument) -> Iterator[Any]:
    """Run an endpoint in a process of its own, where this thread is."""
    with Process(ctx=multiprocessing.get_context('spawn')) as process:
        endpoint = getattr(process, kind.__name__)(argument)
        try:
            yield endpoint
        finally:
            # It has not ended once, beside two busy processes; the end of the process ends it.
            close = Thread(target=endpoint.close, daemon=True)
            close.start()
            close.join(DEADLINE)

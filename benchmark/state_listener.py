# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The listener of the benchmarks: hears what a node publishes, and when.

It reports the first time that it hears the node, takes an order how many answers to wait for,
and reports on them.
"""

import struct
import time
from array import array
from collections.abc import Callable, Mapping, Sequence, Sized
from contextlib import ExitStack, suppress
from typing import Any, Self

import numpy as np
from geometry_msgs.msg import PoseArray
from peer import DEPTH, next_order, obey_benchmark, peer, report, wait_for_end
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from rclpy.task import Future
from sensor_msgs.msg import JointState

_TYPES = {
    'output_state': JointState,
    'body_poses': PoseArray,
    'mechanism_joint_states': JointState,
    'rotor_state': JointState,
}
_SECOND = 1_000_000_000  # ns
_PROBE_SECOND = bytes(4)  # of the stamps of probes, as messages have it
_DEADLINE = 30.0  # s
_SLICE = 0.05  # s


class Listener:
    """Receives messages as bytes; a context manager."""

    def __init__(self, node: Node, callbacks: Mapping[str, Callable[[bytes], None]]) -> None:
        """Listen to topics, by name; answers to probes are kept from the callbacks."""
        self.heard: dict[str, int] = {}
        """When the first message came, ns, by topic."""
        self._topics = callbacks.keys()
        for topic, callback in callbacks.items():
            node.create_subscription(
                _TYPES[topic.rpartition('/')[2]],
                topic,
                self._receiver(topic, callback),
                QoSProfile(depth=DEPTH),
                raw=True,
            )
        self._executor = EventsExecutor()
        self._executor.add_node(node)
        self._never: Future = Future()

    def __enter__(self) -> Self:
        """Give the listener."""
        return self

    def __exit__(self, *_: object) -> None:
        """Stop listening."""
        self._executor.shutdown()

    def wait_until_heard(self) -> None:
        """Receive until something has come on every topic.

        Raises:
            TimeoutError: if that takes too long.
        """
        deadline = time.monotonic() + _DEADLINE
        while self.heard.keys() != self._topics:
            if time.monotonic() > deadline:
                raise TimeoutError(f'heard {[*self.heard]} in {_DEADLINE:g} s')
            self.receive(_SLICE)

    def receive(self, seconds: float) -> None:
        """Receive for some time."""
        # spin_once comes back after every message, and spin not at all.
        self._executor.spin_until_future_complete(self._never, timeout_sec=seconds)

    def _receiver(self, topic: str, callback: Callable[[bytes], None]) -> Callable[[bytes], None]:
        def receive(data: bytes) -> None:
            if data[4:8] == _PROBE_SECOND:
                self.heard.setdefault(topic, time.time_ns())
            else:
                callback(data)

        return receive


class Answers:
    """The answers on one topic: their stamps, and when they came."""

    def __init__(self) -> None:
        """Start with none."""
        self._times = array('q')
        self._stamps = bytearray()

    def __len__(self) -> int:
        """How many there are."""
        return len(self._times)

    def add(self, data: bytes) -> None:
        """Take a message."""
        self._times.append(time.time_ns())
        self._stamps += data[4:12]

    def by_stamp(self) -> dict[int, int]:
        """Give the times at which they came by their stamps, ns."""
        stamps = (s * _SECOND + ns for s, ns in struct.iter_unpack('<iI', self._stamps))
        return dict(zip(stamps, self._times, strict=True))


def main() -> None:
    """Follow the orders until the standard input ends."""
    obey_benchmark()
    with peer('state_listener') as node, ExitStack() as stack, suppress(EOFError):
        outputs = node.declare_parameter('outputs', Parameter.Type.STRING_ARRAY).value
        topics = {topic: Answers() for topic in outputs}
        listener = stack.enter_context(Listener(node, {t: a.add for t, a in topics.items()}))
        report()
        listener.wait_until_heard()
        report(heard=min(listener.heard.values()))
        order = next_order()
        report()
        receive_answers(listener, [*topics.values()], **order)
        report(**latency(*topics.values()))
        wait_for_end()


def receive_answers(
    listener: Listener, topics: Sequence[Sized], *, count: int, quiet: float
) -> None:
    """Receive until every topic has so many, or nothing has come for `quiet` seconds."""
    total, deadline = -1, 0.0
    while min(map(len, topics)) < count:
        if sum(map(len, topics)) > total:
            total, deadline = sum(map(len, topics)), time.monotonic() + quiet
        elif time.monotonic() > deadline:
            return
        listener.receive(_SLICE)


def latency(*topics: Answers) -> dict[str, Any]:
    """How long it took from sending, which the stamp tells, to the last of a message's answers.

    Returns:
        The number of messages `answered` on every topic; `p50`, `p99` and `max` in s.
    """
    first, *others = (answers.by_stamp() for answers in topics)
    answered = set(first).intersection(*others)
    took = [max(times[stamp] for times in (first, *others)) - stamp for stamp in answered]
    median, p99, longest = (np.percentile(took, [50, 99, 100]) / _SECOND).tolist()
    return {'answered': len(answered), 'p50': median, 'p99': p99, 'max': longest}


if __name__ == '__main__':
    main()

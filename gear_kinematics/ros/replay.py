# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Plays the rotor topic of a bag with its timing, and records what comes of it."""

import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from geometry_msgs.msg import PoseArray
from rclpy.duration import Duration
from rclpy.exceptions import NameValidationException
from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState

from gear_kinematics.bag import Bag, ReportProgress
from gear_kinematics.bag.schedule import due_messages, throttled
from gear_kinematics.ros.drivers import DEPTH
from gear_kinematics.ros.live import POLL, ReplayError, replay_node
from gear_kinematics.ros.workarounds.executor import make_executor
from gear_kinematics.wire.topics import JOINT_STATE, OUTPUT_ENCODER, RECORDED_TOPICS

_GRACE = 5.0  # s; subscribers acknowledge messages every 3 s
_AFTERWARDS = 0.2  # s, of which a recording goes on
_RECORDED = {**RECORDED_TOPICS, f'/{OUTPUT_ENCODER}': JOINT_STATE}


@contextmanager
def stopped_by_signals() -> Iterator[Callable[[], bool]]:
    """Replace the effect of SIGINT and SIGTERM by a function that returns whether one came."""
    received: list[int] = []
    previous = {
        number: signal.signal(number, lambda number, _frame: received.append(number))
        for number in (signal.SIGINT, signal.SIGTERM)
    }
    try:
        yield lambda: bool(received)
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)


@dataclass(slots=True)
class Played:
    """Result of `play`."""

    messages: int = 0
    worst_delay: float = 0.0
    """Greatest delay of a message, s."""


def play(
    source: Bag,
    topic: str,
    published: str,
    *,
    rate: float = 1.0,
    loop: bool = False,
    wait: bool = True,
    record: Path | None = None,
    stopped: Callable[[], bool] = lambda: False,
    progress: ReportProgress = lambda _done, _total: None,
) -> Played:
    """Publish a bag's joint states unchanged, with their original timing.

    A late message does not delay the next ones. The publisher is reliable, which is compatible
    with every subscription.

    Args:
        source: an open bag.
        topic: the name in the bag, of JointState messages.
        published: the name to publish it under.
        rate: bag time / real time.
        loop: whether to restart at the end, a mean period after the last message, until stopped.
        wait: whether to wait for a subscriber first.
        record: a folder to create, for a recording of both encoders and of the node meanwhile.
        stopped: returns whether to stop; called at least every 0.1 s.
        progress: called with the number of messages sent.

    Raises:
        BagError: if the bag lacks the topic, has nothing to play or is damaged; the messages
            before the damage have been played. If the recording cannot be written.
        ReplayError: if nothing can be published under that name.
        ValueError: if the rate is out of range.
    """
    source.type_of(topic, JOINT_STATE)
    schedule = due_messages(source, [topic], rate, loop=loop)
    played = Played()
    report = throttled(progress)
    with replay_node('') as node, _recorded(node, record) as pause:
        try:
            publisher = node.create_publisher(JointState, published, QoSProfile(depth=DEPTH))
        except NameValidationException as error:
            raise ReplayError(' '.join(str(error).split())) from error
        while wait and not (stopped() or publisher.get_subscription_count()):
            pause(0.01)
        progress(0, None)
        start = time.monotonic()
        try:
            for due, (_, _, data) in schedule:
                while (left := start + due - time.monotonic()) > 0.0 and not stopped():
                    pause(min(left, POLL))
                if stopped():
                    break
                publisher.publish(data)
                played.messages += 1
                played.worst_delay = max(played.worst_delay, time.monotonic() - start - due)
                report(played.messages, None)
            if record:
                pause(_AFTERWARDS)
        finally:
            # Lost messages are sent again as long as the publisher exists.
            publisher.wait_for_all_acked(Duration(seconds=0.0 if stopped() else _GRACE))
    progress(played.messages, None)
    return played


@contextmanager
def _recorded(node: Node, path: Path | None) -> Iterator[Callable[[float], None]]:
    """Record to a path, if there is one; yields a function that waits some s and records."""
    if path is None:
        yield time.sleep
        return
    from gear_kinematics.bag.writing import BagWriter  # noqa: PLC0415, an extra

    with BagWriter(path) as bag:
        executor = make_executor(context=node.context)
        executor.add_node(node)

        def keep(topic: str, data: bytes) -> None:
            bag.write(topic, time.time_ns(), data)

        for topic, kind in _RECORDED.items():
            bag.add_topic(topic, kind)
            message_type = JointState if kind == JOINT_STATE else PoseArray
            take = partial(keep, topic)
            node.create_subscription(message_type, topic, take, QoSProfile(depth=DEPTH), raw=True)

        def pause(seconds: float) -> None:
            end = time.monotonic() + seconds
            while (left := end - time.monotonic()) > 0.0:
                executor.spin_once(timeout_sec=left)

        try:
            yield pause
        finally:
            executor.shutdown()

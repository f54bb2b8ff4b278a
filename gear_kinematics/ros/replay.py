"""Recorded messages into DDS in their own time: `play` is a driver for whoever listens."""

import importlib.util
import math
import re
import signal
import time
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.machinery import PathFinder
from typing import Any

from rclpy.duration import Duration
from rclpy.exceptions import NameValidationException
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile

from gear_kinematics.bag import Bag, ReportProgress
from gear_kinematics.bag.schedule import due_messages, throttled
from gear_kinematics.ros.live import DEPTH, POLL, ReplayError, live_messages, replay_node
from gear_kinematics.wire.cdr import SECOND

__all__ = ['Played', 'ReplayError', 'live_messages', 'play', 'stopped_by_signals']

_GRACE = 5.0  # s: subscribers acknowledge what they got every 3 s


@contextmanager
def stopped_by_signals() -> Iterator[Callable[[], bool]]:
    """Give a function that tells whether SIGINT or SIGTERM came, in place of their effect."""
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
    """What `play` did."""

    messages: int = 0
    worst_delay: float = 0.0
    """s, by which a message came later than it was due."""


def play(
    source: Bag,
    topics: Mapping[str, str],
    *,
    rate: float = 1.0,
    loop: bool = False,
    start_offset: float = 0.0,
    duration: float = math.inf,
    clock: float = 0.0,
    wait: float = math.inf,
    stopped: Callable[[], bool] = lambda: False,
    progress: ReportProgress = lambda _done, _total: None,
) -> Played:
    """Publish a bag's messages, unchanged, in their own time, as `ros2 bag play` does.

    What is late does not delay what follows. Everything is sent reliably, which listeners of
    every kind can receive.

    Args:
        source: an open bag.
        topics: the names to publish under, by the names in the bag.
        rate: bag time per real time.
        loop: whether to begin anew at the end, a mean period after the last message, until
            stopped. Header stamps and /clock then jump back.
        start_offset: s of bag time to leave out, from the first message of the topics on.
        duration: s of bag time to play, in a loop again and again.
        clock: Hz of the bag's time on /clock; 0 for none.
        wait: s to wait until every topic has a subscriber; 0 does not wait.
        stopped: asked at least every 0.1 s whether to stop.
        progress: told of the messages sent: when the wait is over, then at most ten times a
            second, and at the end.

    Raises:
        BagError: if the bag has no such topics or nothing to play, or is damaged; then what could
            be read has been played.
        ReplayError: if there is no subscriber in time, or a topic's type is not installed.
        ValueError: if a number is out of its range.
    """
    for name, value in (
        ('start offset', start_offset),
        ('duration', duration),
        ('clock', clock),
        ('wait', wait),
    ):
        if not value >= 0.0:
            raise ValueError(f'{name} must not be negative, but is {value:g}')
    types = {topic: source.type_of(topic) for topic in topics}
    schedule = due_messages(source, topics, rate, start_offset, duration, loop=loop)
    played = Played()
    report = throttled(progress)
    with replay_node('') as node:
        publishers = {
            topic: _publisher(node, name, topic, types[topic]) for topic, name in topics.items()
        }
        bag_clock = _Clock(node, clock)
        _wait_for_subscribers(publishers.values(), wait, stopped)
        progress(0, None)
        start = time.monotonic()
        try:
            for due, (topic, received, data) in schedule:
                while (left := start + due - time.monotonic()) > 0.0 and not stopped():
                    next_tick = bag_clock.update(received - round(left * rate * SECOND))
                    time.sleep(min(left, next_tick, POLL))
                if stopped():
                    break
                bag_clock.update(received)
                publishers[topic].publish(data)
                played.messages += 1
                played.worst_delay = max(played.worst_delay, time.monotonic() - start - due)
                report(played.messages, None)
        finally:
            # What got lost on the way is sent again as long as the publisher is there.
            for publisher in publishers.values():
                publisher.wait_for_all_acked(Duration(seconds=0.0 if stopped() else _GRACE))
    progress(played.messages, None)
    return played


class _Clock:
    """Publishes the bag's time on /clock."""

    def __init__(self, node: Node, hertz: float) -> None:
        """Open the topic; for 0 Hz, do nothing."""
        self._period = 1.0 / hertz if hertz else math.inf
        self._next = -math.inf if hertz else math.inf  # of time.monotonic()
        if hertz:
            self._class = _load_class('rosgraph_msgs/msg/Clock')
            self._publisher = node.create_publisher(self._class, '/clock', QoSProfile(depth=10))

    def update(self, bag_time: int) -> float:
        """Publish the time, ns, if it is due; returns the time until the next is due, s."""
        now = time.monotonic()
        if now >= self._next:
            self._next += self._period
            if self._next <= now:  # what was missed is not made up for
                self._next = now + self._period
            message = self._class()
            message.clock.sec, message.clock.nanosec = divmod(bag_time, SECOND)
            self._publisher.publish(message)
        return self._next - now


def _wait_for_subscribers(
    publishers: Collection[Publisher], timeout: float, stopped: Callable[[], bool]
) -> None:
    """Wait until each has a subscriber.

    Raises:
        ReplayError: if one has none after `timeout` s, unless that is 0.
    """
    deadline = time.monotonic() + timeout
    while timeout and not stopped():
        alone = [p.topic_name for p in publishers if not p.get_subscription_count()]
        if not alone:
            return
        if time.monotonic() > deadline:
            raise ReplayError(f'nobody listens to {", ".join(alone)} after {timeout:g} s')
        time.sleep(0.01)


def _publisher(node: Node, name: str, topic: str, message_type: str) -> Publisher:
    try:
        return node.create_publisher(_load_class(message_type), name, QoSProfile(depth=DEPTH))
    except (ImportError, AttributeError) as error:
        raise ReplayError(f'{topic} is of the type {message_type}: {error}') from error
    except NameValidationException as error:
        raise ReplayError(' '.join(str(error).split())) from error


def _load_class(message_type: str) -> Any:
    """Import a message class; a bag, which names it, can have nothing else imported."""
    named = re.fullmatch(r'([a-z]\w*)(?:/msg)?/([A-Z]\w*)', message_type, re.ASCII)
    package = importlib.util.find_spec(named[1]) if named else None
    places = package.submodule_search_locations if package else None
    if not (named and places and PathFinder.find_spec('msg', places)):
        raise ImportError('no message of that name is installed')
    return getattr(importlib.import_module(f'{named[1]}.msg'), named[2])

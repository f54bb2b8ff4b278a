# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Plays bags: publishes recorded messages with the timing of the recording."""

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
from gear_kinematics.ros.drivers import DEPTH
from gear_kinematics.ros.live import POLL, ReplayError, replay_node

_GRACE = 5.0  # s; subscribers acknowledge messages every 3 s


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
    topics: Mapping[str, str],
    *,
    rate: float = 1.0,
    loop: bool = False,
    start_offset: float = 0.0,
    duration: float = math.inf,
    wait: float = math.inf,
    stopped: Callable[[], bool] = lambda: False,
    progress: ReportProgress = lambda _done, _total: None,
) -> Played:
    """Publish a bag's messages unchanged, with their original timing, as `ros2 bag play` does.

    A late message does not delay the next ones. All publishers are reliable, which is compatible
    with every subscription.

    Args:
        source: an open bag.
        topics: published names by the names in the bag.
        rate: bag time / real time.
        loop: whether to restart at the end, a mean period after the last message, until stopped.
        start_offset: s of bag time to skip, from the first message of the topics on.
        duration: s of bag time to play in each loop.
        wait: s to wait until every topic has a subscriber; 0 does not wait.
        stopped: returns whether to stop; called at least every 0.1 s.
        progress: called with the number of messages sent.

    Raises:
        BagError: if the bag lacks a topic, has nothing to play or is damaged; the messages before
            the damage have been played.
        ReplayError: if there is no subscriber in time, or a topic's type is not installed.
        ValueError: if a number is out of range.
    """
    for name, value in {'start offset': start_offset, 'duration': duration, 'wait': wait}.items():
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
        _wait_for_subscribers(publishers.values(), wait, stopped)
        progress(0, None)
        start = time.monotonic()
        try:
            for due, (topic, _, data) in schedule:
                while (left := start + due - time.monotonic()) > 0.0 and not stopped():
                    time.sleep(min(left, POLL))
                if stopped():
                    break
                publishers[topic].publish(data)
                played.messages += 1
                played.worst_delay = max(played.worst_delay, time.monotonic() - start - due)
                report(played.messages, None)
        finally:
            # Lost messages are sent again as long as the publisher exists.
            for publisher in publishers.values():
                publisher.wait_for_all_acked(Duration(seconds=0.0 if stopped() else _GRACE))
    progress(played.messages, None)
    return played


def _wait_for_subscribers(
    publishers: Collection[Publisher], timeout: float, stopped: Callable[[], bool]
) -> None:
    """Wait until each publisher has a subscriber; not for a timeout of 0 s."""
    deadline = time.monotonic() + timeout
    while timeout and not stopped():
        alone = [p.topic_name for p in publishers if not p.get_subscription_count()]
        if not alone:
            return
        if time.monotonic() > deadline:
            raise ReplayError(f'no subscriber on {", ".join(alone)} after {timeout:g} s')
        time.sleep(0.01)


def _publisher(node: Node, name: str, topic: str, message_type: str) -> Publisher:
    try:
        return node.create_publisher(_load_class(message_type), name, QoSProfile(depth=DEPTH))
    except (ImportError, AttributeError) as error:
        raise ReplayError(f'{topic} is of the type {message_type}: {error}') from error
    except NameValidationException as error:
        raise ReplayError(' '.join(str(error).split())) from error


def _load_class(message_type: str) -> Any:
    """Import a message class; refuse any other name, as it comes from the bag."""
    named = re.fullmatch(r'([a-z]\w*)(?:/msg)?/([A-Z]\w*)', message_type, re.ASCII)
    package = importlib.util.find_spec(named[1]) if named else None
    places = package.submodule_search_locations if package else None
    if not (named and places and PathFinder.find_spec('msg', places)):
        raise ImportError('no message of that name is installed')
    return getattr(importlib.import_module(f'{named[1]}.msg'), named[2])

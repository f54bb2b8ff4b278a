# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Subscriptions that are polled: they cost nothing until someone looks."""

import time
from collections import deque
from collections.abc import Iterator
from typing import Any, NamedTuple

from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

from gear_kinematics.ros.drivers import DEPTH
from gear_kinematics.wire.cdr import SECOND

_SPAN = 1.0  # s, over which rates are measured


class NeverExecuted(CallbackGroup):  # type: ignore[misc]  # rclpy has no types
    """A group whose subscriptions wake no executor."""

    def can_execute(self, _entity: Any) -> bool:
        """Leave the messages in the queue of the middleware."""
        return False


class Taken(NamedTuple):
    """A message as it came."""

    data: Any  # CDR, or the message
    received: int  # ns
    number: int | None  # among those of its publisher; None where the middleware does not count


class PolledSubscription:
    """A subscription from which messages are taken when someone asks for them."""

    def __init__(
        self,
        node: Node,
        topic: str,
        message_type: type,
        reliability: ReliabilityPolicy,
        *,
        raw: bool = True,
    ) -> None:
        self._node = node
        self._subscription = node.create_subscription(
            message_type,
            topic,
            lambda _: None,  # never called
            QoSProfile(depth=DEPTH, reliability=reliability),
            raw=raw,
            callback_group=NeverExecuted(),
        )
        self.topic = topic

    def take(self) -> Iterator[Taken]:
        """Yield what has come since the last time, at most one full queue."""
        source = self._subscription
        with source.handle:
            for _ in range(DEPTH):
                if (taken := source.handle.take_message(source.msg_type, source.raw)) is None:
                    return
                data, about = taken
                received = about['received_timestamp'] or time.time_ns()
                yield Taken(data, received, about['publication_sequence_number'])

    def publishers(self) -> int:
        """Count the publishers that are connected."""
        return int(self._subscription.get_publisher_count())

    def close(self) -> None:
        """Unsubscribe."""
        self._node.destroy_subscription(self._subscription)


class Latest(PolledSubscription):
    """The latest message of a topic, and the rate at which they come.

    Best effort is compatible with every publisher, and asks for no acknowledgements.
    """

    def __init__(self, node: Node, topic: str, message_type: type) -> None:
        super().__init__(node, topic, message_type, ReliabilityPolicy.BEST_EFFORT)
        self.last: Taken | None = None
        self._count = 0
        self._counts = deque([(time.monotonic(), 0)])  # by time, s

    def poll(self) -> None:
        """Take what has come."""
        for taken in self.take():
            self.last = taken
            self._count += 1
        now = time.monotonic()
        self._counts.append((now, self._count))
        while len(self._counts) > 2 and now - self._counts[1][0] >= _SPAN:  # noqa: PLR2004
            self._counts.popleft()

    @property
    def rate(self) -> float:
        """Messages per second, over the last second; 0 before there is a span to count in."""
        (start, before), (end, now) = self._counts[0], self._counts[-1]
        return (now - before) / (end - start) if end > start else 0.0

    @property
    def age(self) -> float | None:
        """Time since the last message, s; None before the first."""
        return (time.time_ns() - self.last.received) / SECOND if self.last else None

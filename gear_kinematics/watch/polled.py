# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Subscriptions that are polled: they cost nothing until someone looks."""

import time
from collections.abc import Callable
from typing import Any, NamedTuple

from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState

from gear_kinematics.ros.drivers import DEPTH
from gear_kinematics.state.losses import Losses
from gear_kinematics.wire.cdr import SECOND

_SPAN = 1.0  # s, over which rates are measured


class NeverExecuted(CallbackGroup):  # type: ignore[misc]  # rclpy has no types
    """A callback group whose subscriptions never wake an executor."""

    def can_execute(self, _entity: Any) -> bool:
        """Leave the messages in the queue of the middleware."""
        return False


class Taken(NamedTuple):
    """A message as received."""

    data: bytes  # CDR
    received: int  # ns
    sent: int  # ns, by the clock of the publisher


class Polled:
    """A subscription from which messages are taken only on request.

    Best effort, the default, is compatible with every publisher and asks for no acknowledgements.
    """

    def __init__(
        self,
        node: Node,
        topic: str,
        message_type: type = JointState,
        wanted: Callable[[bytes], bool] = bool,
        qos: QoSProfile | None = None,
    ) -> None:
        """Subscribe to the messages that are `wanted`, with best effort unless `qos` is given."""
        self._node, self._wanted = node, wanted
        self._subscription = node.create_subscription(
            message_type,
            topic,
            lambda _: None,  # never called
            qos or QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT),
            raw=True,
            callback_group=NeverExecuted(),
        )
        self.last: Taken | None = None
        self.count = 0
        self.losses = Losses()  # messages that are missing, if the topic has one publisher
        self._rate: float | None = None  # messages per second, once a second is over
        self._begun = 0  # ns
        self._before = time.monotonic(), 0  # s, and the count then

    def take(self) -> list[Taken]:
        """Take the messages since the last call, at most one full queue."""
        new: list[Taken] = []
        source = self._subscription
        with source.handle:
            for _ in range(DEPTH):
                if (taken := source.handle.take_message(source.msg_type, source.raw)) is None:
                    break
                data, about = taken
                self.losses.note(about.get('publication_sequence_number'))
                if self._wanted(data):
                    received = about['received_timestamp'] or time.time_ns()
                    new.append(Taken(data, received, about['source_timestamp'] or received))
        now, (before, count) = time.monotonic(), self._before
        if new and not self.last:  # a second that began before would have too few
            self._begun, before, count = new[0].received, now, len(new)
            self._before = before, count
        self.last = new[-1] if new else self.last
        self.count += len(new)
        if now >= before + _SPAN:
            self._rate = (self.count - count) / (now - before)
            self._before = now, self.count
        return new

    @property
    def rate(self) -> float:
        """Messages per second, over the last second or since the first message."""
        return self.mean_rate if self._rate is None else self._rate

    @property
    def mean_rate(self) -> float:
        """Messages per second, from the first to the last; 0 if it is not known."""
        span = self.last.received - self._begun if self.last else 0
        return SECOND * (self.count - 1) / span if span > 0 else 0.0

    @property
    def lost(self) -> int:
        """Number of messages that did not arrive, as far as it is known."""
        return self.losses.missing if self.losses.numbered else 0

    def close(self) -> None:
        """Unsubscribe."""
        self._node.destroy_subscription(self._subscription)

"""The inputs of the node: subscriptions to drivers, and the messages lost on the way."""

import time
from collections.abc import Callable

from rclpy.event_handler import QoSRequestedIncompatibleQoSInfo, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSPolicyKind, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions
from sensor_msgs.msg import JointState

from gear_kinematics.ros.workarounds.message_numbers import number_messages
from gear_kinematics.ros.workarounds.new_publishers import NewPublishers
from gear_kinematics.state.diagnostics import EncoderMonitor, InputMonitor

DEPTH = 2000
"""Queued messages on either side of a topic: those of a driver at several kHz while the node is
blocked."""


class DriverInput:
    """Subscribes to the driver of an encoder.

    Its reliability is "best available": reliable unless a driver offers only best effort, which is
    determined when the subscription is created.
    """

    def __init__(
        self,
        node: Node,
        topic: str,
        on_message: Callable[[bytes], None],
        monitor: InputMonitor | EncoderMonitor,
    ) -> None:
        """Subscribe.

        Args:
            node: the subscribing node.
            topic: name of a topic of type JointState.
            on_message: called with the bytes of each message.
            monitor: counts lost messages.
        """
        self._node = node
        self._topic = topic
        self._on_message = on_message
        self._monitor = monitor
        self._silent = False
        self._numbered = True
        self._missing = 0
        """Messages missing between those that came since the last update."""
        self.publishers = 0
        """At the last update."""
        self._subscribe()

    def _subscribe(self) -> None:
        self._next = 0
        """The number of the next message; 0 before the first, as numbers begin with 1."""
        self._heard = False
        """Whether a message had come before the last update."""
        self.subscription = self._node.create_subscription(
            JointState,
            self._topic,
            self._on_message,
            QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_AVAILABLE),
            raw=True,
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
            event_callbacks=SubscriptionEventCallbacks(incompatible_qos=self._on_incompatible),
        )
        number_messages(self.subscription, self._take)
        self.new_publishers = NewPublishers(self.subscription)

    def _on_incompatible(self, event: QoSRequestedIncompatibleQoSInfo) -> None:
        name = self.subscription.topic_name
        override = f'qos_overrides.{name}.subscription.reliability'
        asked_for = self._node.get_parameter(override).value
        best_available = ReliabilityPolicy.BEST_AVAILABLE.name.lower()
        if event.last_policy_kind == QoSPolicyKind.RELIABILITY and asked_for == best_available:
            self._node.get_logger().info(f'{name}: subscribing with best effort, as a driver does')
            self.new_publishers.destroy()
            self._node.destroy_subscription(self.subscription)
            self._subscribe()

    def _take(self, data: bytes, number: int | None) -> None:
        if number == self._next:
            self._next = number + 1
        else:
            self._jump(number)
        self._on_message(data)

    def _jump(self, number: int | None) -> None:
        """Note an unexpected number: the first, one after a loss, or one of another driver."""
        if number is None:
            self._numbered = False
            return
        if 0 < self._next < number:
            self._missing += number - self._next
        self._next = number + 1

    def update(self, timeout: float) -> None:
        """Count the messages lost since the last call, and log whether the driver is silent.

        Losses are unknown while there are two drivers, whose numbers are not told apart, and where
        the middleware does not number messages.

        Args:
            timeout: s without a message after which a driver is silent.
        """
        before, self.publishers = self.publishers, self.subscription.get_publisher_count()
        several = max(before, self.publishers) > 1
        # The first number of another driver in place of one before it says nothing.
        replaced = self.new_publishers.take() and self._heard
        if several:
            self._next = 0
        elif not replaced:
            self._monitor.lost += self._missing
        self._missing, self._heard = 0, self._next > 0
        self._monitor.losses_known = self._numbered and not several and not replaced

        last = self._monitor.last_input
        age = 0.0 if last is None else time.monotonic() - last
        if (age > timeout) == self._silent:
            return
        self._silent = not self._silent
        if self._silent:
            self._node.get_logger().warning(f'no {self._topic} for {age:.1f} s')
        else:
            self._node.get_logger().info(f'{self._topic} is back')

"""The inputs of the node: subscriptions to drivers, and the messages lost on the way."""

import math
import time
from collections.abc import Callable

from rclpy.event_handler import QoSRequestedIncompatibleQoSInfo, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSPolicyKind, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions
from sensor_msgs.msg import JointState

from gear_kinematics.ros.workarounds.lost_messages import LostMessages
from gear_kinematics.state.diagnostics import EncoderMonitor, InputMonitor

DEPTH = 2000
"""Queued messages on either side of a topic: those of a driver at several kHz while the node is
blocked."""
_SETTLING = 0.9
"""s after a driver's first message. Fast DDS reports as lost what a reliable driver published
while the two were connecting, up to 0.2 s after that message on a busy machine. It is less than
the time between two reports, so that only the first report after that message counts none."""


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
        self._subscribe()

    def _subscribe(self) -> None:
        self.silent = True
        """Whether no message has been received yet."""
        self._publishers = 0
        self._settled_at = math.inf
        self.subscription = self._node.create_subscription(
            JointState,
            self._topic,
            self._on_message,
            QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_AVAILABLE),
            raw=True,
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
            event_callbacks=SubscriptionEventCallbacks(incompatible_qos=self._on_incompatible),
        )
        self.losses = LostMessages(self.subscription)

    def _on_incompatible(self, event: QoSRequestedIncompatibleQoSInfo) -> None:
        name = self.subscription.topic_name
        override = f'qos_overrides.{name}.subscription.reliability'
        asked_for = self._node.get_parameter(override).value
        best_available = ReliabilityPolicy.BEST_AVAILABLE.name.lower()
        if event.last_policy_kind == QoSPolicyKind.RELIABILITY and asked_for == best_available:
            self._node.get_logger().info(f'{name}: subscribing with best effort, as a driver does')
            self.count_losses()
            self.losses.destroy()
            self._node.destroy_subscription(self.subscription)
            self._subscribe()

    def begin_to_count_losses(self) -> None:
        """Ignore losses from before and during the connection, which has just been made."""
        self.silent = False
        self._settled_at = time.monotonic() + _SETTLING

    def count_losses(self) -> None:
        """Count the messages lost since the last call, and look for new drivers."""
        lost = self.losses.take()
        now, publishers = time.monotonic(), self.subscription.get_publisher_count()
        if publishers > self._publishers:
            self._settled_at = now + _SETTLING
        self._publishers = publishers
        if not self.silent and now >= self._settled_at:
            self._monitor.lost += lost
        if not publishers:
            self.silent = True

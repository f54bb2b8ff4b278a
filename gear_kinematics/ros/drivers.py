"""The inputs of the node: how it listens to a driver, and what gets lost on the way."""

from collections.abc import Callable

from rclpy.event_handler import (
    QoSRequestedIncompatibleQoSInfo,
    QoSSubscriptionEventType,
    SubscriptionEventCallbacks,
)
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.qos import QoSPolicyKind, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions
from sensor_msgs.msg import JointState

from gear_kinematics.state.diagnostics import EncoderMonitor, InputMonitor

DEPTH = 2000
"""Messages that wait on either side of a topic: what a driver at several kHz sends while the node
is held up."""


class DriverInput:
    """Listens to the driver of an encoder.

    It does so reliably, unless there is a driver that only does best effort. That is what best
    available means; it is decided when the subscription is made.
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
            node: that listens.
            topic: of JointState.
            on_message: takes the bytes of each message.
            monitor: counts what is lost.
        """
        self._node = node
        self._topic = topic
        self._on_message = on_message
        self._monitor = monitor
        self._subscribe()

    def _subscribe(self) -> None:
        self.unheard = True
        """Whether the first message is still to come."""
        self.subscription = self._node.create_subscription(
            JointState,
            self._topic,
            self._on_message,
            QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_AVAILABLE),
            raw=True,
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
            event_callbacks=SubscriptionEventCallbacks(incompatible_qos=self._on_incompatible),
        )
        with self.subscription.handle:
            self.losses = rclpy_implementation.EventHandle(
                self.subscription.handle, QoSSubscriptionEventType.RCL_SUBSCRIPTION_MESSAGE_LOST
            )
            """What the middleware knows of messages that it did not deliver."""

    def _on_incompatible(self, event: QoSRequestedIncompatibleQoSInfo) -> None:
        name = self.subscription.topic_name
        override = f'qos_overrides.{name}.subscription.reliability'
        asked_for = self._node.get_parameter(override).value
        best_available = ReliabilityPolicy.BEST_AVAILABLE.name.lower()
        if event.last_policy_kind == QoSPolicyKind.RELIABILITY and asked_for == best_available:
            self._node.get_logger().info(f'a driver on {name} is best effort: listening likewise')
            self.count_losses()
            self.losses.destroy_when_not_in_use()
            self._node.destroy_subscription(self.subscription)
            self._subscribe()

    def begin_to_count_losses(self) -> None:
        """Forget what the middleware calls lost before the first message came.

        It was sent before driver and node had found each other, or while they did.
        """
        self.count_losses()
        self.unheard = False

    def count_losses(self) -> None:
        """Ask the middleware what it has lost since the last time.

        Were it told of each loss, as of other events, it could come to a deadlock between the
        thread that takes the event and the one that receives: ros2/rmw_fastrtps#890.
        """
        with self.losses:
            status = self.losses.take_event()
        if not self.unheard:
            self._monitor.lost += status.total_count_change

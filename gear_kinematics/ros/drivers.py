# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The inputs of the node: subscriptions to drivers, and the messages lost on the way."""

from collections.abc import Callable
from typing import Any

from rclpy.event_handler import QoSRequestedIncompatibleQoSInfo, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSPolicyKind, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions
from sensor_msgs.msg import JointState

from gear_kinematics.ros.workarounds.private import pass_message_info, with_info
from gear_kinematics.state.losses import Losses
from gear_kinematics.state.monitors import DriverFacts

DEPTH = 2000  # queued messages on either side, for a driver at several kHz and a busy node


class DriverInput:
    """Subscribes to the driver of an encoder, whose messages are of type JointState.

    Its reliability is "best available": reliable unless a driver offers only best effort, which is
    determined when the subscription is created.
    """

    def __init__(
        self,
        node: Node,
        topic: str,
        on_message: Callable[[bytes], None],
        facts: DriverFacts,
    ) -> None:
        """Subscribe; `on_message` gets the bytes of each message, and `facts` are kept."""
        self._node = node
        self._topic = topic
        self._on_message, self._facts = on_message, facts
        self._subscribe()

    def _subscribe(self) -> None:
        self._losses = Losses()
        self._heard = False  # whether a message had come before the last update
        self.subscription = self._node.create_subscription(
            JointState,
            self._topic,
            self._take,
            QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_AVAILABLE),
            raw=True,
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
            event_callbacks=SubscriptionEventCallbacks(incompatible_qos=self._on_incompatible),
        )
        pass_message_info(self.subscription)

    def _on_incompatible(self, event: QoSRequestedIncompatibleQoSInfo) -> None:
        name = self.subscription.topic_name
        override = f'qos_overrides.{name}.subscription.reliability'
        asked_for = self._node.get_parameter(override).value
        best_available = ReliabilityPolicy.BEST_AVAILABLE.name.lower()
        if event.last_policy_kind == QoSPolicyKind.RELIABILITY and asked_for == best_available:
            self._node.get_logger().info(f'{name}: subscribing with best effort, as offered')
            self._node.destroy_subscription(self.subscription)
            self._subscribe()

    def _take(self, message: Any, about: Any = None) -> None:
        """Take a message, with its number where the middleware and this rclpy count."""
        message, about = with_info(message, about)
        self._facts.number = number = about and about['publication_sequence_number']
        self._losses.note(number)
        self._on_message(message)

    def count_losses(self) -> None:
        """Count the drivers, and the messages lost since the last call.

        Losses are unknown with two drivers, whose numbers cannot be told apart, and where the
        middleware does not number messages.
        """
        losses, facts, before = self._losses, self._facts, self._facts.publishers
        drivers = self.subscription.get_publisher_count()
        several = max(before, drivers) > 1
        # If a driver has replaced one that ended, its first number says nothing of losses.
        replaced = before == 0 < drivers and self._heard
        if several:
            losses.next = None
        facts.publishers = drivers
        facts.lost += 0 if several or replaced else losses.missing
        facts.losses_known = losses.numbered and not several and not replaced
        losses.missing, self._heard = 0, losses.next is not None

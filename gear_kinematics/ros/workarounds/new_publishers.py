# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Publishers that a subscription has met, polled instead of reported by a callback.

A callback could deadlock the thread that takes the event and the one that receives:
ros2/rmw_fastrtps#890, seen in rmw_fastrtps 8.4.3.
"""

from rclpy.event_handler import QoSSubscriptionEventType
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.subscription import Subscription


class NewPublishers:
    """The middleware's count of publishers that a subscription has met."""

    def __init__(self, subscription: Subscription) -> None:
        with subscription.handle:
            self._event = rclpy_implementation.EventHandle(
                subscription.handle, QoSSubscriptionEventType.RCL_SUBSCRIPTION_MATCHED
            )

    def take(self) -> int:
        """Return the number met since the last call."""
        with self._event:
            return int(self._event.take_event().total_count_change)

    def destroy(self) -> None:
        """Destroy the handle, which rclpy does not know of."""
        self._event.destroy_when_not_in_use()

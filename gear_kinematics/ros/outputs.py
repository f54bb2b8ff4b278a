# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The outputs of a node: its publishers, by topic, and its warnings."""

import re
import time
from collections.abc import Callable, Iterable

from rcl_interfaces.msg import SetParametersResult
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, QoSPublisherMatchedInfo
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.qos_overriding_options import QoSOverridingOptions

from gear_kinematics.wire.nearest import among, nearest

_WARNING_PERIOD = 1.0  # s


def latched() -> QoSProfile:
    """Create a new profile for each latched topic, since QoS overrides change it."""
    return QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Outputs:
    """Creates the publishers of a node, and publishes on them."""

    def __init__(
        self,
        node: Node,
        on_subscribers: Callable[[QoSPublisherMatchedInfo], None],
        on_failure: Callable[[Publisher, Exception], None],
    ) -> None:
        """Start without publishers.

        `on_subscribers` is called when a subscriber has come or gone, `on_failure` with the
        publisher of a message that was not sent, and the error.
        """
        self.publishers: dict[str, Publisher] = {}
        self._senders: dict[str, Callable[[bytes], None]] = {}
        self._node = node
        self._on_subscribers = on_subscribers
        self._on_failure = on_failure

    def create(
        self,
        topic: str,
        message_type: type,
        qos: QoSProfile,
        on_subscribers: Callable[[QoSPublisherMatchedInfo], None] | None = None,
    ) -> None:
        """Create the publisher on a topic, perhaps with another callback than the common one."""
        publisher = self._node.create_publisher(
            message_type,
            topic,
            qos,
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
            event_callbacks=PublisherEventCallbacks(
                incompatible_qos=lambda _: None,  # the next report names the subscriber
                matched=on_subscribers or self._on_subscribers,
            ),
        )
        self.publishers[topic] = publisher
        # `Publisher.publish` of rclpy 7.1 checks the type and holds the handle, which takes longer
        # than encoding the message; other releases may lack this.
        self._senders[topic] = getattr(publisher.handle, 'publish_raw', publisher.publish)

    def subscribed(self, topics: Iterable[str]) -> list[str]:
        """Return those of the topics that have subscribers."""
        return [topic for topic in topics if self.publishers[topic].get_subscription_count()]

    def send(self, messages: Iterable[tuple[str, bytes]]) -> None:
        """Publish serialised messages, given with their topics, and report failures."""
        # All are encoded first: a listener is still awake at the second if it follows at once.
        for topic, message in list(messages):
            try:
                self._senders[topic](message)
            except rclpy_implementation.RCLError as error:
                self._on_failure(self.publishers[topic], error)


class PublishingNode(Node):  # type: ignore[misc]  # rclpy has no types
    """A node whose outputs can be waited for, and which warns at most once a second."""

    _outputs: Outputs
    _next_warning = 0.0
    """s of a steady clock. The logger's own throttle takes 0.3 ms for each text that it drops."""

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> SetParametersResult:
        """Set parameters; the reason of a refusal names the parameter and types."""
        known = self.get_parameters_by_prefix('')
        for name in [each.name for each in parameter_list if each.name not in known]:
            own = [full for full in known if full.endswith(f'.{name}')]  # of actuators
            hint = among(name, own) if own else nearest(name, known)
            return SetParametersResult(reason=f'unknown parameter `{name}`{hint}')
        result = super().set_parameters_atomically(parameter_list)
        names = ', '.join(parameter.name for parameter in parameter_list)
        if result.reason.startswith('Wrong parameter type'):  # rclpy 9.1 numbers them
            result.reason = re.sub(r'\d+', lambda n: Parameter.Type(int(n[0])).name, result.reason)
        if not result.successful and names not in result.reason:
            result.reason = f'{names}: {result.reason}'
        return result

    def wait_for_delivery(self, timeout: float) -> None:
        """Wait until reliable subscribers have received all outputs; `timeout` is in s."""
        deadline = time.monotonic() + timeout
        for publisher in self._outputs.publishers.values():
            left = max(0.0, deadline - time.monotonic())
            publisher.wait_for_all_acked(Duration(seconds=left))

    def _warn(self, text: str) -> None:
        if time.monotonic() >= self._next_warning:
            self.get_logger().warning(text)
            self._next_warning = time.monotonic() + _WARNING_PERIOD  # after logging, not before

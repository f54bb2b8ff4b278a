# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A node with its publishers, by topic, and its warnings."""

import re
import time
from collections.abc import Callable, Iterable
from importlib import import_module
from typing import Any

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
from gear_kinematics.wire.topics import TOPICS, base_name

_WARNING_PERIOD = 1.0  # s


def latched() -> QoSProfile:
    """Create a new profile for each latched topic, since QoS overrides change it."""
    return QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def message_type(name: str) -> Any:
    """Return the class of a type of messages, such as sensor_msgs/msg/JointState."""
    package, _, kind = name.split('/')
    return getattr(import_module(f'{package}.msg'), kind)


class PublishingNode(Node):  # type: ignore[misc]  # rclpy has no types
    """A node with publishers of serialised messages, with a warning a second for each subject."""

    def __init__(self, name: str, **options: Any) -> None:
        # By subjects, s of a steady clock. The logger's own throttle takes 0.3 ms for each text
        # that it drops.
        self._next_warnings: dict[str, float] = {}
        self.outputs: dict[str, Publisher] = {}  # the publishers by topic
        self._senders: dict[str, Callable[[bytes], None]] = {}
        super().__init__(name, **options)

    def open_output(
        self,
        topic: str,
        qos: QoSProfile,
        on_subscribers: Callable[[QoSPublisherMatchedInfo], None] | None = None,
    ) -> None:
        """Create the publisher on one of TOPICS; `on_subscribers` replaces `note_subscribers`."""
        known = TOPICS.get(topic) or TOPICS[base_name(topic)]
        publisher = self.create_publisher(
            message_type(known.type),
            topic,
            qos,
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
            event_callbacks=PublisherEventCallbacks(
                incompatible_qos=lambda _: None,  # the next report names the subscriber
                matched=on_subscribers or self.note_subscribers,
            ),
        )
        self.outputs[topic] = publisher
        # `Publisher.publish` of rclpy 7.1 checks the type and holds the handle, which takes longer
        # than encoding the message; other releases may lack this.
        self._senders[topic] = getattr(publisher.handle, 'publish_raw', publisher.publish)

    def note_subscribers(self, _event: QoSPublisherMatchedInfo) -> None:
        """Take note that a subscriber has come or gone."""

    def note_unsent(self, publisher: Publisher, error: Exception) -> None:
        """Take note of a message that was not sent."""
        self._warn(f'{publisher.topic_name} not sent: {error}')

    def send(self, messages: Iterable[tuple[str, bytes]]) -> None:
        """Publish serialised messages, given with their topics, and report failures."""
        # Encode all first: a listener is still awake for a second message that follows at once.
        for topic, message in list(messages):
            try:
                self._senders[topic](message)
            except rclpy_implementation.RCLError as error:
                self.note_unsent(self.outputs[topic], error)

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
        for publisher in self.outputs.values():
            left = max(0.0, deadline - time.monotonic())
            publisher.wait_for_all_acked(Duration(seconds=left))

    def _warn(self, text: str, subject: str = '') -> None:
        if time.monotonic() >= self._next_warnings.get(subject, 0.0):
            self.get_logger().warning(text)
            # After logging, not before.
            self._next_warnings[subject] = time.monotonic() + _WARNING_PERIOD

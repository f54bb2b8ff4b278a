# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Access to parts of rclpy that are not public."""

from collections.abc import Mapping
from typing import Any

from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.subscription import Subscription


def given_parameters(node: Node) -> Mapping[str, Parameter]:
    """Return the parameters that a node was given by name, also those that it does not declare."""
    return getattr(node, '_parameter_overrides', {})


def pass_message_info(subscription: Subscription) -> None:
    """Call back with a message and its info, whatever the signature; see `with_info`."""
    subscription._callback_type = Subscription.CallbackType.WithMessageInfo  # noqa: SLF001


def with_info(message: Any, info: Any = None) -> tuple[Any, Any]:
    """Return the message and its info; the EventsExecutor of rclpy 7.1 passes both as one."""
    return message if type(message) is tuple else (message, info)

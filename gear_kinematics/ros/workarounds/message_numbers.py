# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Messages with their number among those of their publisher, whatever executor takes them.

rclpy passes both to a callback of two arguments; the EventsExecutor of rclpy 7.1 passes them as
one tuple, so that such a callback fails.
"""

from collections.abc import Callable
from typing import Any

from rclpy.subscription import Subscription


def number_messages(
    subscription: Subscription, callback: Callable[[bytes, int | None], None]
) -> None:
    """Let a raw subscription call back with each message and its number.

    The number is None where the middleware or this rclpy does not count.
    """

    def take(message: Any, about: Any = None) -> None:
        if type(message) is tuple:
            message, about = message
        callback(message, about and about['publication_sequence_number'])

    subscription.callback = take
    # By its signature, it would get the message alone.
    subscription._callback_type = Subscription.CallbackType.WithMessageInfo  # noqa: SLF001

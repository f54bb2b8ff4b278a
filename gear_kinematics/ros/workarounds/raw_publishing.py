# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Publishing of serialised messages without the checks of rclpy.

`Publisher.publish` of rclpy 7.1 checks the type and holds the handle around `publish_raw`, which
takes longer than encoding the message. Neither is needed: these are bytes, and nobody can destroy
the publisher meanwhile, as `publish_raw` keeps the GIL. Other releases may lack it.
"""

from collections.abc import Callable

from rclpy.publisher import Publisher


def raw_sender(publisher: Publisher) -> Callable[[bytes], None]:
    """Return the function that publishes a serialised message."""
    sender: Callable[[bytes], None] = getattr(publisher.handle, 'publish_raw', publisher.publish)
    return sender

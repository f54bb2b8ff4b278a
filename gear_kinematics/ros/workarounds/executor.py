# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The EventsExecutor of rclpy, where there is one.

It needs the least time for a message, but is experimental in rclpy 7.1: some releases for Jazzy
lack it, and that of others does nothing if it is to spin without a timeout.
"""

from rclpy.context import Context
from rclpy.executors import Executor, SingleThreadedExecutor

ENDLESS = 3600.0  # timeout for spinning in a loop, s


def make_executor(kind: str = 'auto', context: Context | None = None) -> Executor:
    """Create the executor that the parameter `executor` selects; ValueError if rclpy lacks it."""
    if kind != 'single_threaded':
        try:
            from rclpy.experimental.events_executor import EventsExecutor  # noqa: PLC0415
        except ImportError:
            if kind == 'events':
                raise ValueError(
                    'this rclpy has no EventsExecutor: executor must not be events'
                ) from None
        else:
            return EventsExecutor(context=context)
    return SingleThreadedExecutor(context=context)

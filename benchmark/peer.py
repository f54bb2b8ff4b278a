# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What driver and listener have in common: a ROS node that follows orders, see `processes`."""

import json
import select
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import rclpy
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from gear_kinematics.ros.workarounds.shutdown import shut_down

DEPTH = 100_000
"""Messages that can wait at this end of a topic: more than ever do, so that no loss is ours."""


def obey_benchmark() -> None:
    """End by SIGTERM, in good order, but not by the Ctrl-C that is meant for the benchmark."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit())


@contextmanager
def peer(name: str, arguments: list[str] | None = None) -> Iterator[Node]:
    """Give a node without anything to it; its arguments are those of the process unless given."""
    rclpy.init(args=arguments, signal_handler_options=SignalHandlerOptions.NO)
    node = Node(name, enable_rosout=False, start_parameter_services=False)
    try:
        yield node
    finally:
        shut_down(node)


def report(**values: Any) -> None:
    """Send a report."""
    print(json.dumps(values), flush=True)


def order_waits(timeout: float) -> bool:
    """Tell whether there is an order, or the end of them, within so many seconds."""
    return bool(select.select([sys.stdin], [], [], timeout)[0])


def next_order() -> dict[str, Any]:
    """Wait for the next order.

    Raises:
        EOFError: if there are no more.
    """
    if line := sys.stdin.readline():
        return dict(json.loads(line))
    raise EOFError


def wait_for_end() -> None:
    """Wait until there are no more orders; until then, what was lost is sent again."""
    sys.stdin.read()

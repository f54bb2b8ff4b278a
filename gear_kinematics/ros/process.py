# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The process of a node: executor, signals and shutdown."""

import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from itertools import pairwise
from pathlib import Path
from threading import Event, Thread
from typing import Any

import rclpy
from rclpy.exceptions import ParameterException
from rclpy.executors import Executor, ExternalShutdownException
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future

from gear_kinematics.ros.workarounds.executor import ENDLESS, make_executor
from gear_kinematics.ros.workarounds.fastdds_profile import use_profile
from gear_kinematics.ros.workarounds.shutdown import shut_down

_STOP_TIMEOUT = 1.0  # s to process received messages
_DELIVERY_TIMEOUT = 0.1  # s to deliver outputs; some subscribers acknowledge only every 3 s
_UNUSABLE = 2  # exit code: unusable parameters or arguments


def main(make_node: Callable[..., Any], program: str) -> int:
    """Make a `PublishingNode` and run it until SIGINT or SIGTERM; returns the exit code."""
    signals = _caught_signals()
    try:
        use_profile()
        rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
        files = [Path(file) for option, file in pairwise(sys.argv) if option == '--params-file']
        node = make_node(parameter_files=files)
        executor = make_executor(node.get_parameter('executor').value)
    except (ParameterException, ValueError, RuntimeError) as error:
        unknown = isinstance(error, rclpy_implementation.UnknownROSArgsError)
        cause = 'unknown arguments ' if unknown else ''
        print(f'{program}: {cause}{error}', file=sys.stderr)
        rclpy.try_shutdown()
        return _UNUSABLE
    executor.add_node(node)
    # ExternalShutdownException: other code in this process has shut rclpy down.
    with suppress(ExternalShutdownException), _stopped(executor, signals) as stopped:
        while not stopped.done():
            executor.spin_until_future_complete(stopped, timeout_sec=ENDLESS)
        node.wait_for_delivery(_DELIVERY_TIMEOUT)
    executor.shutdown()
    shut_down(node)
    return 0


def _caught_signals() -> tuple[int, int]:
    """Let SIGINT and SIGTERM write to a pipe, without any other effect; returns its two ends."""
    reader, writer = os.pipe()
    os.set_blocking(writer, False)
    signal.set_wakeup_fd(writer)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: None)
    return reader, writer


@contextmanager
def _stopped(executor: Executor, signals: tuple[int, int]) -> Iterator[Future]:
    """Create a future that is done after the first signal and the messages received before it.

    A thread waits for the signal, as the main thread runs no Python while it waits for messages.
    """
    reader, writer = signals
    stopped, ended = Future(), Event()

    def wait() -> None:
        os.read(reader, 1)
        executor.create_task(stopped.set_result, None)
        if not ended.wait(_STOP_TIMEOUT):
            stopped.set_result(None)

    thread = Thread(target=wait)
    thread.start()
    try:
        yield stopped
    finally:
        ended.set()
        os.write(writer, b'\0')  # ends the thread if there was no signal
        thread.join()

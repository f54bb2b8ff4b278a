"""The process of the node: executor, signals and shutdown."""

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from itertools import pairwise
from pathlib import Path
from threading import Event, Thread
from typing import NamedTuple

import rclpy
from rclpy.context import Context
from rclpy.exceptions import ParameterException
from rclpy.executors import Executor, ExternalShutdownException, SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future

from gear_kinematics.ros.leaving import leave
from gear_kinematics.ros.middleware import use_profile
from gear_kinematics.ros.node import GearStatePublisher

_SPIN_TIMEOUT = 3600.0  # s; without a timeout, the EventsExecutor of some releases does nothing
_STOP_TIMEOUT = 1.0  # s to process received messages
_DELIVERY_TIMEOUT = 0.1  # s to deliver outputs; some subscribers acknowledge only every 3 s
_UNUSABLE = 2  # exit code: unusable parameters or arguments


def make_executor(kind: str = 'auto', context: Context | None = None) -> Executor:
    """Create the executor that the parameter `executor` selects.

    Raises:
        ValueError: if this rclpy lacks it.
    """
    if kind != 'single_threaded':
        try:
            # Some releases of Jazzy lack it.
            from rclpy.experimental.events_executor import EventsExecutor  # noqa: PLC0415
        except ImportError:
            if kind == 'events':
                raise ValueError(
                    'this rclpy has no EventsExecutor: executor must not be events'
                ) from None
        else:
            return EventsExecutor(context=context)
    return SingleThreadedExecutor(context=context)


def main(args: list[str] | None = None) -> int:
    """Run the node until SIGINT or SIGTERM; returns the exit code."""
    signals = _caught_signals()
    try:
        use_profile()
        rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
        arguments = sys.argv if args is None else args
        files = [Path(file) for option, file in pairwise(arguments) if option == '--params-file']
        node = GearStatePublisher(parameter_files=files)
        executor = make_executor(node.get_parameter('executor').value)
    except (ParameterException, ValueError, RuntimeError) as error:
        unknown = (
            'unknown arguments '
            if isinstance(error, rclpy_implementation.UnknownROSArgsError)
            else ''
        )
        print(f'gear_state_publisher: {unknown}{error}', file=sys.stderr)
        rclpy.try_shutdown()
        return _UNUSABLE
    executor.add_node(node)
    # ExternalShutdownException: other code in this process has shut rclpy down.
    with suppress(ExternalShutdownException), _stopped(executor, signals) as stopped:
        while not stopped.done():
            executor.spin_until_future_complete(stopped, timeout_sec=_SPIN_TIMEOUT)
        node.wait_for_delivery(_DELIVERY_TIMEOUT)
    executor.shutdown()
    leave(node)
    return 0


class _Pipe(NamedTuple):
    """File descriptors of a pipe."""

    reader: int
    writer: int


def _caught_signals() -> _Pipe:
    """Create a pipe to which SIGINT and SIGTERM are written, without any other effect."""
    pipe = _Pipe(*os.pipe())
    os.set_blocking(pipe.writer, False)
    signal.set_wakeup_fd(pipe.writer)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: None)
    return pipe


@contextmanager
def _stopped(executor: Executor, signals: _Pipe) -> Iterator[Future]:
    """Create a future that is done after the first signal and the messages received before it.

    A thread waits for the signal, as the main thread runs no Python while it waits for messages.
    """
    stopped, ended = Future(), Event()

    def wait() -> None:
        os.read(signals.reader, 1)
        executor.create_task(stopped.set_result, None)
        if not ended.wait(_STOP_TIMEOUT):
            stopped.set_result(None)

    thread = Thread(target=wait)
    thread.start()
    try:
        yield stopped
    finally:
        ended.set()
        os.write(signals.writer, b'\0')  # ends the thread if there was no signal
        thread.join()

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Output of commands on terminals and in pipes, and progress bars."""

import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from rich import console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from gear_kinematics.report.document import printable
from gear_kinematics.ros.workarounds.shared_memory import check_shared_memory


def complain(error: object) -> None:
    """Print an error in one line to stderr, with unsafe characters escaped."""
    with suppress(OSError):  # a full disk or a closed pipe; there is still the exit code
        print(f'gearkin: {printable(" ".join(str(error).split()))}', file=sys.stderr)


def announce_ros(participants: int) -> None:
    """Say on a terminal that ROS starts; warn of low shared memory, or raise SharedMemoryError."""
    if sys.stderr.isatty():
        print('starting ROS ...', file=sys.stderr)
    if warning := check_shared_memory(participants):
        complain(warning)


@contextmanager
def closed_pipe_ignored() -> Iterator[None]:
    """Allow the reader of stdout to close the pipe early."""
    try:
        yield
        sys.stdout.flush()
    except BrokenPipeError:
        sys.stdout = open(os.devnull, 'w')  # noqa: PTH123, SIM115, for the interpreter's last flush


@contextmanager
def stopped_by_signals() -> Iterator[Callable[[], bool]]:
    """Let SIGINT and SIGTERM have no effect; yields a function that returns whether one came."""
    received: list[int] = []
    previous = {
        number: signal.signal(number, lambda number, _frame: received.append(number))
        for number in (signal.SIGINT, signal.SIGTERM)
    }
    try:
        yield lambda: bool(received)
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)


class Console(console.Console):
    """Raises BrokenPipeError, instead of ending the process as rich does."""

    @property
    def is_terminal(self) -> bool:
        """Whether a table can be shown; on a dumb terminal rich would show nothing of it."""
        return os.environ.get('TERM') not in {'dumb', 'unknown'} and super().is_terminal

    def on_broken_pipe(self) -> None:
        """Raise the error for `closed_pipe_ignored`."""
        raise BrokenPipeError


@contextmanager
def message_progress(
    name: str, *, quiet: bool = False
) -> Iterator[Callable[[int, int | None], None]]:
    """Show messages and the remaining time; yields the function to report progress."""
    with progress('messages', quiet=quiet) as bars:
        task = bars.add_task(printable(name), total=None)

        def update(done: int, total: int | None) -> None:
            bars.update(task, completed=done, total=total)

        yield update


def progress(unit: str, *, quiet: bool = False) -> Progress:
    """Create a progress bar on the terminal, on stderr to keep stdout clean."""
    return Progress(
        TextColumn('{task.description}', markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn(unit),
        TimeRemainingColumn(),
        console=console.Console(stderr=True),
        transient=True,
        disable=quiet or not sys.stderr.isatty(),
    )

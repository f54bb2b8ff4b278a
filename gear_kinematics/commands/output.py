# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Output of commands on terminals and in pipes, and progress bars."""

import os
import signal
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any, Self, TypeVar

from gear_kinematics.report.document import Document, printable
from gear_kinematics.report.text import lines
from gear_kinematics.ros.workarounds.shared_memory import check_shared_memory

if TYPE_CHECKING:
    from rich.progress import Progress

    from gear_kinematics.report.terminal import Console

T = TypeVar('T')


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


def progress(unit: str, *, quiet: bool = False) -> 'NoProgress | Progress':
    """Create a progress bar on the terminal, on stderr to keep stdout clean."""
    if quiet or not sys.stderr.isatty():
        return NoProgress()
    from rich import console  # noqa: PLC0415, slow
    from rich import progress as bars  # noqa: PLC0415, slow

    return bars.Progress(
        bars.TextColumn('{task.description}', markup=False),
        bars.BarColumn(),
        bars.MofNCompleteColumn(),
        bars.TextColumn(unit),
        bars.TimeRemainingColumn(),
        console=console.Console(stderr=True),
        transient=True,
    )


class NoProgress:
    """Stands in for the bar where there is no terminal, and shows nothing."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """End nothing."""

    def add_task(self, *_: object, **_options: object) -> Any:
        """Show no task."""

    def update(self, *_: object, **_options: object) -> None:
        """Show no advance."""

    def track(self, done: Iterable[T], **_options: object) -> Iterable[T]:
        """Return what is done."""
        return done


def show(document: Document, *, brief: bool) -> None:
    """Print a report: tables on a terminal, one row per line elsewhere."""
    if console := terminal():
        from gear_kinematics.report.terminal import render  # noqa: PLC0415, slow

        render(document, console, brief=brief)
    else:
        for line in lines(document, brief=brief):
            print(line)


def say(text: str) -> None:
    """Print a text; a terminal breaks it between words."""
    if console := terminal():
        console.print(text, markup=False, highlight=False)
    else:
        print(text, flush=True)


def terminal() -> 'Console | None':
    """Return the console of stdout, or None where rich would show no tables."""
    # What rich goes by, which takes a third of the start of a command and is not imported in vain.
    if not ({'FORCE_COLOR', 'TTY_COMPATIBLE'} & os.environ.keys() or sys.stdout.isatty()):
        return None
    from gear_kinematics.report.terminal import Console  # noqa: PLC0415, slow

    console = Console()
    return console if console.is_terminal else None

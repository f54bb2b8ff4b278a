"""Where commands write and in which form: the terminal or a pipe, files, bars of progress."""

import os
import stat
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from rich import box, console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeRemainingColumn,
)
from rich.table import Table
from rich.text import Text

from gear_kinematics.kinematics import Mechanism
from gear_kinematics.report.wording import printable
from gear_kinematics.ros.shared_memory import check_shared_memory
from gear_kinematics.shape.teeth import InterferenceError, tooth_pair


def complain(error: object) -> None:
    """Say in one line on stderr what is wrong, whatever names come up in it."""
    with suppress(OSError):  # a full disk or a closed pipe; the exit code still tells
        print(f'gearkin: {printable(" ".join(str(error).split()))}', file=sys.stderr)


def warn_of_shared_memory(participants: int) -> None:
    """Say on stderr if there is little for so many DDS participants, before ROS is imported.

    Raises:
        SharedMemoryError: if there is too little to import it.
    """
    if warning := check_shared_memory(participants):
        complain(warning)


@contextmanager
def closed_pipe_ignored() -> Iterator[None]:
    """Print to a pipe whose reader may have seen enough."""
    try:
        yield
        sys.stdout.flush()
    except BrokenPipeError:
        sys.stdout = open(os.devnull, 'w')  # noqa: PTH123, SIM115, for the interpreter's last flush


class Console(console.Console):
    """Raises BrokenPipeError, where rich ends the process."""

    def on_broken_pipe(self) -> None:
        """Leave it to `closed_pipe_ignored`."""
        raise BrokenPipeError


def facts(pairs: Iterable[tuple[str, str]]) -> Table:
    """Names and values beside each other."""
    grid = Table.grid(padding=(0, 2))
    for name, value in pairs:
        grid.add_row(Text(name, 'dim'), Text(value))
    return grid


def numbers(*columns: str) -> Table:
    """A table for numbers, which are never broken; headings may be, by a line feed."""
    table = Table(box=box.SIMPLE_HEAD, show_edge=False, padding=(0, 1, 0, 0), header_style='dim')
    for column in columns:
        table.add_column(column, justify='right', no_wrap=True, vertical='bottom')
    return table


def write(target: str, text: str) -> None:
    """Write a file that is whole or not there at all; '-' is stdout.

    Raises:
        ValueError: if it cannot be written, naming it.
    """
    if target == '-':
        with closed_pipe_ignored():
            print(text, end='' if text.endswith('\n') else '\n')
    else:
        write_file(target, text.encode())


def write_file(target: str, content: bytes) -> None:
    """Write a file that is whole or not there at all.

    Raises:
        ValueError: if it cannot be written, naming it.
    """
    given = Path(target)
    path = given.resolve()
    unfinished = path.with_name(f'.gearkin.{os.getpid()}.tmp')  # of a length that always fits
    try:
        if given.exists() and not given.is_file():  # a pipe, perhaps: nothing to put in its place
            given.write_bytes(content)
            return
        with unfinished.open('xb') as file:  # follows no link that is there
            if path.exists():
                os.fchmod(file.fileno(), stat.S_IMODE(path.stat().st_mode))
            file.write(content)
        unfinished.replace(path)
    except OSError as error:
        raise ValueError(f'{target}: {error.strerror}') from error
    finally:
        with suppress(OSError):
            unfinished.unlink()


def tell_of_circles(mechanism: Mechanism, module: float) -> None:
    """Say why the gears of a drawing have no teeth, where they cannot mesh; module in m."""
    try:
        tooth_pair(mechanism, module)
    except InterferenceError as error:
        print(f'The gears are drawn as circles: {error}')


@contextmanager
def message_progress(name: str) -> Iterator[Callable[[int, int | None], None]]:
    """Show messages/s and the remaining time; gives what is to be called with each batch."""
    with progress('messages') as bars:
        task = bars.add_task(printable(name), total=None)

        def update(count: int, total: int | None) -> None:
            bars.update(task, advance=count, total=total)

        yield update


def progress(unit: str) -> Progress:
    """A progress bar on the terminal, on stderr so that stdout stays clean."""
    return Progress(
        TextColumn('{task.description}', markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        _Speed(unit),
        TimeRemainingColumn(),
        console=console.Console(stderr=True),
        transient=True,
        disable=not sys.stderr.isatty(),
    )


class _Speed(TextColumn):
    """How many come in a second."""

    def __init__(self, unit: str) -> None:
        super().__init__('')
        self._unit = unit

    def render(self, task: Any) -> Text:
        speed = task.finished_speed or task.speed
        return Text(f'{speed:,.0f} {self._unit}/s' if speed else '')

"""Output of commands to terminals, pipes and files, and progress bars."""

import argparse
import os
import stat
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from types import MappingProxyType
from typing import Any, TextIO

from rich import console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.text import Text

from gear_kinematics.bag import ReportProgress
from gear_kinematics.commands.origin import origin
from gear_kinematics.commands.paper_size import image_file
from gear_kinematics.commands.targets import check_targets
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.report.document import Document, printable
from gear_kinematics.report.html import to_html
from gear_kinematics.report.image import to_image
from gear_kinematics.report.json import to_json
from gear_kinematics.report.junit import to_junit
from gear_kinematics.report.text import render
from gear_kinematics.ros.workarounds.shared_memory import check_shared_memory
from gear_kinematics.shape.teeth import InterferenceError, tooth_pair

_FORMS: Mapping[str, Callable[[Document], str]] = {
    'json': to_json,
    'junit': to_junit,
    'html': to_html,
}


def complain(error: object) -> None:
    """Print an error in one line to stderr, with unsafe characters escaped."""
    with suppress(OSError):  # a full disk or a closed pipe; there is still the exit code
        print(f'gearkin: {printable(" ".join(str(error).split()))}', file=sys.stderr)


def warn_of_shared_memory(participants: int) -> None:
    """Warn if there is little shared memory for the DDS participants, before importing ROS.

    Raises:
        SharedMemoryError: if there is too little to import it.
    """
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


class Console(console.Console):
    """Raises BrokenPipeError, instead of ending the process as rich does."""

    def on_broken_pipe(self) -> None:
        """Raise the error for `closed_pipe_ignored`."""
        raise BrokenPipeError


class Reporter:
    """Writes a document in the forms given by options; see `arguments.add_report_forms`."""

    def __init__(
        self,
        options: argparse.Namespace,
        sections: int = 1,
        others: Mapping[str, str | None] = MappingProxyType({}),
        *,
        compared: bool = False,
        brief: bool = False,
    ) -> None:
        """Check that everything can be written, before any other work.

        Args:
            options: the parsed arguments.
            sections: number of sections of the document.
            others: targets of further options, which the command writes itself.
            compared: whether the last section compares the others, and has the figure of the plot.
            brief: whether a section that passed is one line in a pipe.

        Raises:
            ValueError: if options exclude each other, or a file must not or cannot be written.
            ModuleNotFoundError: if a form needs a package that is not installed.
        """
        self._targets = {
            form: target for form in _FORMS if (target := getattr(options, form, None))
        }
        self._options = options
        self._plot: str | None = options.plot
        given = {f'--{form}': target for form, target in self._targets.items()}
        given |= {'--plot': self._plot, **others}
        to_stdout = [option for option, target in given.items() if target == '-']
        if len(to_stdout) > 1:
            raise ValueError(f'only one report can go to stdout, not {" and ".join(to_stdout)}')
        if '--html' in to_stdout and sys.stdout.isatty():
            raise ValueError('--html -: a page goes into a file or a pipe, not to a terminal')
        check_targets(options, given)
        self._silent = bool(to_stdout)
        self._quiet, self._brief = options.quiet, brief
        if not self._plot and (options.width_mm, options.dpi) != (None, None):
            raise ValueError('--width-mm and --dpi need --plot')
        if self._plot:
            if sections > 1 and not compared:
                raise ValueError('--plot takes one recording')
            self._image = image_file(options, self._plot)
        if 'html' in self._targets:
            import_module('plotly')

    def write(self, document: Document, configs: Iterable[Path] = ()) -> None:
        """Print the document, unless a form of it goes to stdout, and write the files.

        Args:
            document: the report.
            configs: the parameter files that were used.
        """
        document = replace(document, origin=origin(self._options, configs))
        if not self._silent:
            with closed_pipe_ignored():
                shown = document.of_failed() if self._quiet else document
                render(shown, Console(), brief=self._brief)
        if self._plot:
            figure = document.figure
            if not figure:
                raise ValueError(f'{self._plot}: there is nothing to plot')
            write_file(self._plot, to_image(figure, self._image))
        for form, target in self._targets.items():
            write(target, _FORMS[form](document))


def write(target: str, text: str) -> None:
    """Write a file completely or not at all; '-' is stdout.

    Raises:
        ValueError: if the file cannot be written, naming it.
    """
    if target == '-':
        with closed_pipe_ignored():
            print(text, end='' if text.endswith('\n') else '\n')
    else:
        write_file(target, text.encode())


def write_file(target: str, content: bytes) -> None:
    """Write a file completely or not at all.

    Raises:
        ValueError: if the file cannot be written, naming it.
    """
    given = Path(target)
    path = given.resolve()
    unfinished = path.with_name(f'.gearkin.{os.getpid()}.tmp')  # never too long a name
    try:
        if given.exists() and not given.is_file():  # such as a pipe, which must not be replaced
            given.write_bytes(content)
            return
        with unfinished.open('xb') as file:  # follows no existing link
            if path.exists():
                os.fchmod(file.fileno(), stat.S_IMODE(path.stat().st_mode))
            file.write(content)
        unfinished.replace(path)
    except OSError as error:
        raise ValueError(f'{target}: {error.strerror}') from error
    finally:
        with suppress(OSError):
            unfinished.unlink()


def warn_if_teeth_cannot_mesh(
    mechanism: Mechanism, module: float, stream: TextIO | None = None
) -> None:
    """Print why gears are drawn without teeth, if these cannot mesh; module in m.

    The text goes to a stream, by default to stdout.
    """
    try:
        tooth_pair(mechanism, module)
    except InterferenceError as error:
        print(f'The gears are drawn as circles: {error}', file=stream)


@contextmanager
def message_progress(name: str, *, quiet: bool = False) -> Iterator[ReportProgress]:
    """Show messages/s and the remaining time; yields the function to report progress."""
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
        _Speed(unit),
        TimeRemainingColumn(),
        console=console.Console(stderr=True),
        transient=True,
        disable=quiet or not sys.stderr.isatty(),
    )


class _Speed(TextColumn):
    """Units per second."""

    def __init__(self, unit: str) -> None:
        super().__init__('')
        self._unit = unit

    def render(self, task: Any) -> Text:
        speed = task.finished_speed or task.speed
        return Text(f'{speed:,.0f} {self._unit}/s' if speed else '')

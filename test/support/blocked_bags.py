# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""gearkin as a process, and bags in the midst of which it can be caught."""

import io
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from contextlib import chdir, contextmanager, redirect_stderr, redirect_stdout, suppress
from pathlib import Path

from gear_kinematics.commands.cli import main

BAGS = Path(__file__).resolve().parents[2] / 'bags'
DEADLINE = 60.0  # s: far beyond anything but a failure
GEARKIN = 'import sys; from gear_kinematics.__main__ import gearkin; sys.exit(gearkin())'


def gearkin(*arguments, code=GEARKIN, **options) -> subprocess.CompletedProcess[str]:
    """Run a command to its end."""
    return finished([sys.executable, '-c', code, *arguments], **options)


def finished(command, **options) -> subprocess.CompletedProcess[str]:
    """Run a program to its end, whatever its exit code."""
    options = {'stdout': subprocess.PIPE, 'stderr': subprocess.PIPE, 'timeout': DEADLINE} | options
    return subprocess.run([*map(str, command)], text=True, check=False, **options)


def gearkin_here(*arguments, cwd='.') -> subprocess.CompletedProcess[str]:
    """Run a command in this process, which needs no time to start, where no process matters."""
    words = [*map(str, arguments)]
    output, errors = io.StringIO(), io.StringIO()
    with chdir(cwd), redirect_stdout(output), redirect_stderr(errors):
        try:
            code = main(words)
        except SystemExit as left:  # of argparse
            code = left.code
    return subprocess.CompletedProcess(words, code, output.getvalue(), errors.getvalue())


def refusal(*arguments, report='') -> str:
    """Run a command that prints one line on why it cannot do its work, and give the reason.

    `report` is a pattern of what it prints besides.
    """
    done = gearkin_here(*arguments)
    assert done.returncode == 2
    assert re.fullmatch(report, done.stdout, re.DOTALL), done.stdout
    found = re.fullmatch('gearkin: (.*)\n', done.stderr)
    assert found, done.stderr
    return found[1]


def facts(output: str) -> dict[str, str]:
    """Read the facts of the plain report about one recording, by subject and column."""
    found = {}
    for line in output.splitlines():
        first, *others = line.split(': ', 1)[1].split('; ')
        *about, name, value = first.split(': ')
        values = [(name, value), *(other.partition(': ')[::2] for other in others)]
        found |= {': '.join([*about, column]): text for column, text in values}
    return found


@contextmanager
def running_gearkin(*arguments, code=GEARKIN, **options):
    """Start a command, in a process group of its own of which nothing is left at the end."""
    command = [sys.executable, '-c', code, *map(str, arguments)]
    options = {'stdout': subprocess.PIPE, 'stderr': subprocess.PIPE} | options
    with started(command, **options) as process:
        yield process


@contextmanager
def started(command, **options):
    """Start a process and kill its group at the end."""
    with subprocess.Popen(command, text=True, start_new_session=True, **options) as process:
        try:
            yield process
        finally:
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)


def wait_until(condition, what):
    """Wait until a condition holds, and return what it gave."""
    begin = time.monotonic()
    deadline = begin + DEADLINE
    while not (result := condition()):
        now = time.monotonic()
        assert now < deadline, f'waited in vain for {what}'
        time.sleep(max(0.01, 15.0 * (now - begin)))  # so that others have the processor
        begin = time.monotonic()
    return result


class BlockedBag:
    """A copy of a bag at which every reader stops, because its file is a pipe without data.

    A context manager; at its end the readers find the file empty.
    """

    def __init__(self, source: Path, path: Path) -> None:
        """Make the copy."""
        self.path = path
        shutil.copytree(source, path)
        (self._file,) = (file for file in path.iterdir() if file.suffix in {'.mcap', '.db3'})
        self._whole = path / 'whole'
        self._file.rename(self._whole)
        os.mkfifo(self._file)

    def __enter__(self):
        # Open for both, so that neither this nor a reader waits for the other.
        self._pipe = os.open(self._file, os.O_RDWR)
        return self

    def __exit__(self, *_):
        os.close(self._pipe)

    def readers(self) -> list[int]:
        """Give the ids of the processes that are at it."""
        found, own = [], self._file.stat()
        for process in filter(str.isdecimal, (entry.name for entry in os.scandir('/proc'))):
            with suppress(OSError), os.scandir(f'/proc/{process}/fd') as opened:
                if any(os.path.samestat(each.stat(), own) for each in opened):
                    found.append(int(process))
        return sorted({*found} - {os.getpid()})

    def reader(self) -> int:
        """Wait for the first process that is at it, and sleeps: a signal will wake it."""

        def sleeping() -> list[int]:
            return [reader for reader in self.readers() if self._state(reader) == 'S']

        return wait_until(sleeping, f'a reader of {self.path}')[0]

    @staticmethod
    def _state(process: int) -> str:
        return Path(f'/proc/{process}/stat').read_text('utf-8').rpartition(')')[2].split()[0]

    def heal(self) -> None:
        """Put the whole file in its place, for those that come from now on."""
        self._whole.rename(self._file)

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Programs that a benchmark runs side by side, each a process of its own.

They talk to each other over ROS, and to the benchmark in lines of JSON: orders on their standard
input, reports on their standard output.
"""

import json
import os
import select
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple, Self

NODE = (sys.executable, '-m', 'gear_kinematics.ros')
"""The command that runs gear_state_publisher."""

_FOLDER = Path(__file__).resolve().parent
PROFILE = _FOLDER.parent / 'config' / 'fastdds.xml'
"""The profile of Fast DDS that the node uses by default."""
ANNOUNCING = _FOLDER / 'announcing.xml'
"""A profile for peers that every node discovers soon after its start.

Otherwise some nodes wait up to 3 s for the peer's next announcement, as Fast DDS loses replies to
the first announcement of a new participant.
"""
_PAGE = os.sysconf('SC_PAGE_SIZE')
_PATIENCE = 1.0  # s
_ON_PROCESSOR = 2  # Linux's CPUCLOCK_SCHED


def program(name: str) -> tuple[str, ...]:
    """Give the command that runs a Python program of this folder."""
    return sys.executable, str(_FOLDER / name)


class Surroundings(NamedTuple):
    """What the programs of one benchmark run in: topics and a log of their own."""

    log: Path
    arguments: list[str]
    environment: dict[str, str]

    def with_profile(self, profile: Path) -> Self:
        """Give the same with a profile for Fast DDS."""
        chosen = {'FASTRTPS_DEFAULT_PROFILES_FILE': str(profile)}
        return self._replace(environment=self.environment | chosen)


@contextmanager
def private_surroundings() -> Iterator[Surroundings]:
    """Give surroundings that nobody else is in, on this machine only."""
    with TemporaryDirectory() as folder:
        environment = {
            'ROS_DOMAIN_ID': str(1 + os.getpid() % 101),
            **os.environ,
            'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST',
            'ROS_LOG_DIR': folder,
        }
        arguments = ['--ros-args', '-r', f'__ns:=/benchmark_{os.getpid()}']
        yield Surroundings(Path(folder, 'log'), arguments, environment)


class Program:
    """A running program; a context manager, which ends it."""

    def __init__(
        self, command: Sequence[str], surroundings: Surroundings, folder: Path | None = None
    ) -> None:
        """Start it, in a folder that has the package it runs, if that is not this one."""
        self._name = Path(command[-1]).name
        self._log = surroundings.log
        self.started = time.time_ns()
        """When, ns."""
        with self._log.open('a', encoding='utf-8') as log:
            self._process = subprocess.Popen(  # noqa: S603, the project's own
                [*command, *surroundings.arguments],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=log,
                text=True,
                env=surroundings.environment,
                cwd=folder,
            )

    def __enter__(self) -> Self:
        """Give the running program."""
        return self

    def __exit__(self, *_: object) -> None:
        """End it."""
        self._process.stdin.close()
        while self._process.poll() is None:
            self._process.terminate()  # again and again: rclpy.spin() can miss a signal
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(_PATIENCE)
        self._process.stdout.close()

    def tell(self, **order: Any) -> None:
        """Send an order."""
        print(json.dumps(order), file=self._process.stdin, flush=True)

    def reports(self) -> bool:
        """Tell whether there is a report, so that `report` would not wait."""
        return bool(select.select([self._process.stdout], [], [], 0.0)[0])

    def report(self) -> dict[str, Any]:
        """Wait for the next report.

        Raises:
            RuntimeError: if the program has ended instead.
        """
        if line := self._process.stdout.readline():
            return dict(json.loads(line))
        raise RuntimeError(f'{self._name} has ended:\n{self.log()}')

    def log(self) -> str:
        """Give what all programs in these surroundings have written to their standard error."""
        return self._log.read_text('utf-8')

    def cpu_time(self) -> float:
        """Give the time that its threads have spent on processors so far, s."""
        clock = (~self._process.pid << 3) | _ON_PROCESSOR  # what clock_getcpuclockid(3) gives
        return time.clock_gettime(clock)

    def memory(self) -> int:
        """Give its resident memory, bytes."""
        _, resident, *_ = Path(f'/proc/{self._process.pid}/statm').read_text('ascii').split()
        return int(resident) * _PAGE

    def own_memory(self) -> int:
        """Give its memory with its part of what it shares with other processes (PSS), bytes."""
        rollup = Path(f'/proc/{self._process.pid}/smaps_rollup').read_text('ascii')
        return next(1024 * int(line.split()[1]) for line in rollup.splitlines() if 'Pss:' in line)

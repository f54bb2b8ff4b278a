# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A Dask cluster on this machine."""

import json
import os
import sys
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest
from blocked_bags import BAGS, started, wait_until


class Cluster:
    """A Dask scheduler and workers on the loopback interface, in a folder of their own."""

    def __init__(self, folder: Path, stack: ExitStack, *, allowed_failures: int = 3) -> None:
        """Start the scheduler."""
        folder.mkdir()
        self._folder = folder
        self._stack = stack
        self._environment = os.environ | {
            'DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES': str(allowed_failures),
            'PYTHONPATH': os.pathsep.join(map(str, (BAGS.parent, *filter(None, sys.path)))),
        }
        self._file = folder / 'scheduler.json'
        self.scheduler = self._start('scheduler', '--port', '0')
        wait_until(lambda: self._file.exists() and self._file.stat().st_size, 'the scheduler')
        self.address = wait_until(self._address, "the scheduler's address")

    def _address(self) -> str:
        try:
            return json.loads(self._file.read_text('utf-8'))['address']
        except ValueError:
            return ''

    def add_worker(self, *arguments: str):
        """Start a worker of one thread; none is left to itself when its scheduler is gone."""
        log = self._folder / f'worker {len(list(self._folder.iterdir()))}'
        return self._start('worker', '--nthreads', '1', '--local-directory', str(log), *arguments)

    def _start(self, role: str, *arguments: str):
        log = self._stack.enter_context(
            (self._folder / f'{role} {len(list(self._folder.iterdir()))}.log').open('w')
        )
        command = [sys.executable, '-m', 'dask', role, '--scheduler-file', str(self._file)]
        command += ['--host', '127.0.0.1', '--no-dashboard', *arguments]
        return self._stack.enter_context(
            started(command, cwd=self._folder, env=self._environment, stdout=log, stderr=log)
        )


@contextmanager
def cluster(folder: Path, **options):
    pytest.importorskip('distributed')
    with ExitStack() as stack:
        yield Cluster(folder, stack, **options)

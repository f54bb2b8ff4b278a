# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Works through many recordings in several processes of this machine."""

import multiprocessing
import os
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Any, Generic, NamedTuple, TypeVar

_RETRIES = 2  # further attempts at a recording whose process dies

Task = TypeVar('Task')
Report = TypeVar('Report')


@dataclass(frozen=True, slots=True)
class Work(Generic[Task, Report]):
    """The work on each of many recordings."""

    run: Callable[..., Report]
    """A module-level function of a task and, optionally, a `ReportProgress`. Its report contains
    any error about the recording."""
    lost: Callable[[Task, str], Report]
    """Makes the report on a recording whose process died repeatedly, from the cause."""


class _Worker(NamedTuple):
    """A process that answers tasks with reports."""

    process: BaseProcess
    connection: 'Connection[Any, Any]'
    """Connection that ends with the process, which alone has its other side."""


def on_this_machine(
    work: Work[Task, Report], tasks: Sequence[Task], jobs: int
) -> Iterator[tuple[Task, Report]]:
    """Work in several processes; yields tasks and reports as they are ready.

    A recording whose process dies is tried again in another one, and finally reported as lost.
    """
    left = deque((task, _RETRIES) for task in tasks)
    idle = list[_Worker]()
    busy = dict[Any, tuple[_Worker, Task, int]]()
    try:
        while left or busy:
            while left and len(busy) < jobs:
                worker = idle.pop() if idle else _started(work.run)
                task, retries = left.popleft()
                busy[worker.connection] = worker, task, retries
                with suppress(OSError):  # it has died, as waiting for its report will show
                    worker.connection.send(task)
            for connection in wait(list(busy)):
                worker, task, retries = busy[connection]
                try:
                    report = worker.connection.recv()
                except (EOFError, OSError):
                    if retries:
                        left.appendleft((task, retries - 1))
                    else:
                        yield task, work.lost(task, 'its worker died repeatedly')
                else:
                    idle.append(worker)
                    yield task, report
                del busy[connection]
    finally:
        for worker, *_ in busy.values():
            worker.process.terminate()
        for worker in idle:
            worker.connection.close()
            worker.process.join()


def _started(run: Callable[[Task], Report]) -> _Worker:
    # Forking would copy the threads of a progress bar in an arbitrary state.
    context = multiprocessing.get_context('spawn')
    connection, other_side = context.Pipe()
    with other_side:
        process = context.Process(target=_answer, args=(other_side, run), daemon=True)
        with _guarded():
            process.start()
    return _Worker(process, connection)


def _answer(connection: 'Connection[Any, Any]', run: Callable[[Any], Any]) -> None:
    """Work on tasks until the connection is closed, or the owner of this process is killed."""
    if parent := multiprocessing.parent_process():
        threading.Thread(target=_end_after, args=[parent], daemon=True).start()
    with suppress(EOFError):
        while True:
            connection.send(run(connection.recv()))


def _end_after(process: BaseProcess) -> None:
    process.join()
    os._exit(1)


@contextmanager
def _guarded() -> Iterator[None]:
    """Start processes that ignore Ctrl-C, on which their owner ends them.

    They are run with `python -c`, and import nothing from the current folder.
    """
    name = 'PYTHONSAFEPATH'
    safe, blocked = os.environ.get(name, ''), signal.pthread_sigmask(signal.SIG_BLOCK, ())
    os.environ[name] = '1'
    try:
        resource_tracker.ensure_running()  # a process too; it unblocks SIGINT as it starts
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        yield
    finally:
        os.environ[name] = safe  # an empty value means unset
        signal.pthread_sigmask(signal.SIG_SETMASK, blocked)

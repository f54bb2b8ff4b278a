# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Works through many recordings in processes of this machine or on a Dask cluster."""

import concurrent.futures
import logging
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing.process import BaseProcess
from typing import Any, Generic, TypeVar

from gear_kinematics.bag.errors import cause

_RETRIES = 2
"""Further attempts at a recording whose process dies; Dask makes its own."""
_CONNECT_TIMEOUT = 10.0  # s
_PATIENCE = 60.0  # s to wait for a cluster without workers
_DIED = 'its worker died repeatedly'

Task = TypeVar('Task')
Report = TypeVar('Report')


class SchedulerError(ValueError):
    """The Dask cluster cannot be used; the text names it and the cause."""


@dataclass(frozen=True, slots=True)
class Work(Generic[Task, Report]):
    """What is done with each of many recordings."""

    run: Callable[[Task], Report]
    """A function of a module. Its report contains any error about the recording."""
    lost: Callable[[Task, str], Report]
    """The report on a recording that no worker could be found for, from the cause."""
    absolute: Callable[[Task], Task]
    """The same task with paths that workers with another working directory understand."""


_Run = Callable[[Sequence[Task]], Iterator[tuple[int, Report]]]
"""Works on tasks; yields reports by their numbers, without those whose workers died."""


def on_this_machine(
    work: Work[Task, Report], tasks: Sequence[Task], jobs: int
) -> Iterator[tuple[Task, Report]]:
    """Work in several processes; yields tasks and reports as they are ready.

    A recording whose process dies is tried again, and finally reported as lost.
    """
    # A process that dies ends its pool. It was working on one of the first unfinished recordings.
    return _retried(work, tasks, lambda some: _in_a_pool(work, some, jobs), jobs, _RETRIES)


def _retried(
    work: Work[Task, Report],
    tasks: Sequence[Task],
    run: _Run[Task, Report],
    suspects: int,
    retries: int,
) -> Iterator[tuple[Task, Report]]:
    """Work on all; where a worker dies, try the first unfinished tasks, the suspects, alone."""
    left = list(tasks)
    while left:
        done = set[int]()
        for number, report in run(left):
            done.add(number)
            yield left[number], report
        left = [task for number, task in enumerate(left) if number not in done]
        for task in left[:suspects]:
            alone = (report for _ in range(retries) for _, report in run([task]))
            yield task, next(alone, None) or work.lost(task, _DIED)
        left = left[suspects:]


def _in_a_pool(
    work: Work[Task, Report], tasks: Sequence[Task], jobs: int
) -> Iterator[tuple[int, Report]]:
    """Yield the reports by the numbers of their tasks; those of a pool that died are missing."""
    # Forking would copy the threads of a progress bar in an arbitrary state.
    context = multiprocessing.get_context('spawn')
    others = multiprocessing.active_children()
    futures = dict[concurrent.futures.Future[Report], int]()
    with (
        _without_current_folder(),
        concurrent.futures.ProcessPoolExecutor(jobs, context, _end_with_parent) as pool,
    ):
        try:
            with _interrupts_blocked(), suppress(BrokenProcessPool):
                for number, task in enumerate(tasks):
                    futures[pool.submit(work.run, task)] = number
            for future in concurrent.futures.as_completed(futures):
                with suppress(BrokenProcessPool):
                    yield futures[future], future.result()
        except BaseException:  # the remaining reports are not wanted
            for process in multiprocessing.active_children():
                if process not in others:
                    process.terminate()
            raise


def _end_with_parent() -> None:
    """End this process of a pool when its owner is killed."""
    if parent := multiprocessing.parent_process():
        threading.Thread(target=_end_after, args=[parent], daemon=True).start()


def _end_after(process: BaseProcess) -> None:
    process.join()
    os._exit(1)


@contextmanager
def _interrupts_blocked() -> Iterator[None]:
    """Start processes that ignore Ctrl-C, on which their owner ends them."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def _without_current_folder() -> Iterator[None]:
    """Start processes, run with `python -c`, that import nothing from the current folder."""
    name = 'PYTHONSAFEPATH'
    before = os.environ.get(name, '')  # an empty value means unset
    os.environ[name] = '1'
    try:
        yield
    finally:
        os.environ[name] = before


def on_cluster(
    work: Work[Task, Report], tasks: Sequence[Task], scheduler: str
) -> Iterator[tuple[Task, Report]]:
    """Work on a Dask cluster; yields tasks and reports as they are ready.

    This package must be installed on the scheduler and the workers, and the workers must see the
    recordings under the same paths. A recording whose worker dies is tried again on another, and
    finally reported as lost.

    Raises:
        SchedulerError: if the cluster cannot be reached.
        ModuleNotFoundError: if dask is not installed.
    """
    import distributed  # noqa: PLC0415, an extra

    for name in ('distributed', 'distributed.client'):  # the reports have all that matters
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        distributed.comm.get_address_host_port(scheduler)  # a client would take long to close
        client = distributed.Client(scheduler, timeout=_CONNECT_TIMEOUT, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        raise SchedulerError(f'{scheduler}: no Dask scheduler there: {error}') from error
    with client:
        # Dask gives up every recording that was assigned to a dead worker.
        yield from _retried(
            work, tasks, lambda some: _on_workers(client, work, some), len(tasks), retries=1
        )


def _on_workers(
    client: Any, work: Work[Task, Report], tasks: Sequence[Task]
) -> Iterator[tuple[int, Report]]:
    """Yield the reports by the numbers of their tasks; those whose workers died are missing."""
    import distributed  # noqa: PLC0415, an extra

    waiting = {
        client.submit(work.run, work.absolute(task), pure=False): number
        for number, task in enumerate(tasks)
    }
    while waiting:
        with suppress(TimeoutError):
            for future in distributed.as_completed(waiting, client.loop, timeout=_PATIENCE):
                number = waiting.pop(future)
                try:
                    yield number, future.result()
                except distributed.KilledWorker:
                    continue
                except Exception as error:  # noqa: BLE001, of the cluster, not the recording
                    yield (
                        number,
                        work.lost(tasks[number], f'not done by the cluster: {cause(error)}'),
                    )
        if waiting and not client.scheduler_info()['workers']:
            for number in waiting.values():
                yield number, work.lost(tasks[number], 'the cluster has no workers for it')
            return

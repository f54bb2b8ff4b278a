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

_TRIES = 3
"""Attempts at a recording whose worker dies."""
_CONNECT_TIMEOUT = 10.0  # s
_PATIENCE = 60.0  # s to wait for a cluster without workers

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


def on_this_machine(
    work: Work[Task, Report], tasks: Sequence[Task], jobs: int
) -> Iterator[tuple[Task, Report]]:
    """Work in several processes; yields tasks and reports as they are ready.

    A recording whose process dies is tried again, and finally reported as lost.
    """
    left = list(tasks)
    while left:
        lost = []
        for task, report in _in_a_pool(work, left, jobs):
            if report:
                yield task, report
            else:
                lost.append(task)
        # A process that dies ends its pool. It was working on one of the first unfinished
        # recordings; to find out on which, each of them gets a pool of its own.
        numbers = {id(task): number for number, task in enumerate(left)}
        lost.sort(key=lambda task: numbers[id(task)])
        for task in lost[:jobs]:
            yield task, _tried_alone(work, task) or _lost(work, task)
        left = lost[jobs:]


def _tried_alone(work: Work[Task, Report], task: Task) -> Report | None:
    for _ in range(_TRIES - 1):
        for _, report in _in_a_pool(work, [task], jobs=1):
            if report:
                return report
    return None


def _in_a_pool(
    work: Work[Task, Report], tasks: Sequence[Task], jobs: int
) -> Iterator[tuple[Task, Report | None]]:
    """Yield each task with its report, or None if a process died."""
    # Forking would copy the threads of a progress bar in an arbitrary state.
    context = multiprocessing.get_context('spawn')
    others = multiprocessing.active_children()
    with (
        _current_folder_shunned(),
        concurrent.futures.ProcessPoolExecutor(jobs, context, _end_with_parent) as pool,
    ):
        try:
            with _interrupts_blocked():
                futures = {_submit(pool, work, task): task for task in tasks}
            for future in concurrent.futures.as_completed(futures):
                try:
                    yield futures[future], future.result()
                except BrokenProcessPool:
                    yield futures[future], None
        except BaseException:  # the remaining reports are not wanted
            for process in multiprocessing.active_children():
                if process not in others:
                    process.terminate()
            raise


def _submit(
    pool: concurrent.futures.Executor, work: Work[Task, Report], task: Task
) -> concurrent.futures.Future[Report]:
    try:
        return pool.submit(work.run, task)
    except BrokenProcessPool as error:
        failed = concurrent.futures.Future[Report]()
        failed.set_exception(error)
        return failed


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
def _current_folder_shunned() -> Iterator[None]:
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

    Args:
        work: what is done with each recording.
        tasks: the recordings.
        scheduler: such as tcp://host:8786.

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
        lost = []
        for task, report in _on_workers(client, work, tasks):
            if report:
                yield task, report
            else:
                lost.append(task)
        # Dask gives up every recording that was assigned to a dead worker; to find the cause, each
        # is tried alone.
        for task in lost:
            for _, report in _on_workers(client, work, [task]):
                yield task, report or _lost(work, task)


def _on_workers(
    client: Any, work: Work[Task, Report], tasks: Sequence[Task]
) -> Iterator[tuple[Task, Report | None]]:
    """Yield each task with its report, or None if workers died."""
    import distributed  # noqa: PLC0415, an extra

    waiting = {client.submit(work.run, work.absolute(task), pure=False): task for task in tasks}
    while waiting:
        with suppress(TimeoutError):
            for future in distributed.as_completed(waiting, client.loop, timeout=_PATIENCE):
                task = waiting.pop(future)
                try:
                    yield task, future.result()
                except distributed.KilledWorker:
                    yield task, None
                except Exception as error:  # noqa: BLE001, of the cluster, not the recording
                    cause = ' '.join(str(error).split())
                    yield task, work.lost(task, f'not done by the cluster: {cause}')
        if waiting and not client.scheduler_info()['workers']:
            for task in waiting.values():
                yield task, work.lost(task, 'the cluster has no workers for it')
            return


def _lost(work: Work[Task, Report], task: Task) -> Report:
    return work.lost(task, 'its worker died repeatedly')

"""Validates one bag, or many in processes of this machine or on a Dask cluster."""

import concurrent.futures
import logging
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from multiprocessing.process import BaseProcess
from pathlib import Path
from types import MappingProxyType
from typing import Any

from gear_kinematics.bag import Bag, BagError, Message, ReportProgress
from gear_kinematics.bag.errors import unexpected
from gear_kinematics.bag.roles import Topics, find_corrected_topics, find_topics
from gear_kinematics.kinematics import Mechanism, gear_from_mapping
from gear_kinematics.report.document import Verdict
from gear_kinematics.state.calibration_file import Calibration
from gear_kinematics.validation.output_topics import Tolerances
from gear_kinematics.validation.report import BagReport
from gear_kinematics.validation.validator import Validator

_TRIES = 3
"""Attempts at a bag whose worker dies."""
_CONNECT_TIMEOUT = 10.0  # s
_PATIENCE = 60.0  # s to wait for a cluster without workers
_TOPICS = Topics()


@dataclass(frozen=True, slots=True)
class Task:
    """A bag, and how to validate it."""

    bag: Path
    parameters: Mapping[str, Any]
    """Parameters of the node, as `parameters.load` returns them."""
    config: str
    """Their file."""
    tolerances: Tolerances
    allow_offset: bool = False
    strict: bool = False
    rotor_topic: str | None = None
    """None, as for the other topics: found by type and name."""
    output_topic: str | None = None
    poses_topic: str | None = None
    calibration: Calibration | None = None
    """Of the node that was recorded."""
    calibration_file: str = ''
    """Its file."""
    debug: bool = False
    """Whether to print tracebacks of unexpected errors to stderr."""


class SchedulerError(ValueError):
    """The Dask cluster cannot be used; the text names it and the cause."""


def validate_bag(
    task: Task,
    progress: ReportProgress | None = None,
    play: Callable[..., Iterable[Message]] | None = None,
) -> BagReport:
    """Validate one bag; the report contains any error about the recording.

    Args:
        task: the bag, and how to validate it.
        progress: called after each batch; the total counts all topics of the bag.
        play: `live_messages`, to validate the outputs of a live node instead of recorded ones.

    Raises:
        MechanismError: if the parameters describe no mechanism.
    """
    poses = isinstance(gear_from_mapping(task.parameters), Mechanism)
    try:
        with Bag(task.bag) as bag:
            given = {
                'rotor': task.rotor_topic,
                'output': task.output_topic,
                'poses': task.poses_topic,
            }
            topics = find_topics(bag, given, outputs=not play, poses=poses)
            if play:
                messages = play(bag, task.parameters, rotor_topic=topics.rotor)
                # Nothing is lost by a recorder here.
                return validate_messages(replace(task, strict=True), messages, progress)
            corrected = find_corrected_topics(bag, topics.output)
            messages = bag.messages((*topics, *corrected.values()))
            return validate_messages(
                task, messages, progress, topics, bag.message_count, corrected
            )
    except BagError as error:
        return _unusable(task, str(error))
    except Exception as error:
        if play:
            raise
        return _unusable(task, f'{task.bag}: {unexpected(error, debug=task.debug)}')


def validate_messages(
    task: Task,
    messages: Iterable[Message],
    progress: ReportProgress | None = None,
    topics: Topics = _TOPICS,
    total: int | None = None,
    corrected: Mapping[str, str] = MappingProxyType({}),
) -> BagReport:
    """Validate the readable messages of a bag; otherwise like `validate_bag`."""
    validator = Validator(
        task.parameters,
        topics=topics,
        tolerances=task.tolerances,
        allow_offset=task.allow_offset,
        strict=task.strict,
        calibration=task.calibration,
        corrected=corrected,
    )
    damage = None
    try:
        validator.feed(messages, progress, total)
    except BagError as error:
        damage = str(error)
    report = validator.report(str(task.bag), error=damage)
    if validator.judges_correction:
        finding = f'the corrected output is compared with that of {task.calibration_file}'
        report = replace(report, findings=(finding, *report.findings))
    return replace(report, config=task.config)


def validate_on_this_machine(tasks: Sequence[Task], jobs: int) -> Iterator[BagReport]:
    """Validate bags in several processes; yields the reports as they are ready.

    A bag whose process dies is tried again, and finally reported as unusable.
    """
    left = list(tasks)
    while left:
        lost = []
        for task, report in _in_a_pool(left, jobs):
            if report:
                yield report
            else:
                lost.append(task)
        # A process that dies ends its pool. It was working on one of the first unfinished bags;
        # to find out on which, each of them gets a pool of its own.
        numbers = {id(task): number for number, task in enumerate(left)}
        lost.sort(key=lambda task: numbers[id(task)])
        for task in lost[:jobs]:
            tries = (_in_a_pool([task], jobs=1) for _ in range(_TRIES - 1))
            reports = (report for attempt in tries for _, report in attempt if report)
            yield next(reports, None) or _lost(task)
        left = lost[jobs:]


def _in_a_pool(tasks: Sequence[Task], jobs: int) -> Iterator[tuple[Task, BagReport | None]]:
    """Yield each bag with its report, or None if a process died."""
    # Forking would copy the threads of a progress bar in an arbitrary state.
    context = multiprocessing.get_context('spawn')
    others = multiprocessing.active_children()
    with (
        _current_folder_shunned(),
        concurrent.futures.ProcessPoolExecutor(jobs, context, _end_with_parent) as pool,
    ):
        try:
            with _interrupts_blocked():
                futures = {_submit(pool, task): task for task in tasks}
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


def _submit(pool: concurrent.futures.Executor, task: Task) -> concurrent.futures.Future[BagReport]:
    try:
        return pool.submit(validate_bag, task)
    except BrokenProcessPool as error:
        failed = concurrent.futures.Future[BagReport]()
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


def validate_on_cluster(tasks: Sequence[Task], scheduler: str) -> Iterator[BagReport]:
    """Validate bags on a Dask cluster; yields the reports as they are ready.

    This package must be installed on the scheduler and the workers, and the workers must see the
    bags under the same paths. A bag whose worker dies is tried again on another, and finally
    reported as unusable.

    Args:
        tasks: the bags.
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
        for task, report in _on_workers(client, tasks):
            if report:
                yield report
            else:
                lost.append(task)
        # Dask gives up every bag that was assigned to a dead worker; to find the cause, each is
        # tried alone.
        for task in lost:
            for _, report in _on_workers(client, [task]):
                yield report or _lost(task)


def _on_workers(client: Any, tasks: Sequence[Task]) -> Iterator[tuple[Task, BagReport | None]]:
    """Yield each bag with its report, or None if workers died."""
    import distributed  # noqa: PLC0415, an extra

    waiting = {
        # The workers have another working directory.
        client.submit(validate_bag, replace(task, bag=task.bag.absolute()), pure=False): task
        for task in tasks
    }
    while waiting:
        with suppress(TimeoutError):
            for future in distributed.as_completed(waiting, client.loop, timeout=_PATIENCE):
                task = waiting.pop(future)
                try:
                    yield task, replace(future.result(), bag=str(task.bag))
                except distributed.KilledWorker:
                    yield task, None
                except Exception as error:  # noqa: BLE001, of the cluster, not the bag
                    cause = ' '.join(str(error).split())
                    yield task, _unusable(task, f'{task.bag}: not done by the cluster: {cause}')
        if waiting and not client.scheduler_info()['workers']:
            for task in waiting.values():
                yield task, _unusable(task, f'{task.bag}: the cluster has no workers for it')
            return


def _lost(task: Task) -> BagReport:
    return _unusable(task, f'{task.bag}: its worker died repeatedly')


def _unusable(task: Task, error: str) -> BagReport:
    return BagReport(str(task.bag), Verdict.UNUSABLE, config=task.config, error=error)

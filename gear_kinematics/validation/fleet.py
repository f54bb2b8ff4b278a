"""Validating bags: one, many in processes of this machine, or many on a Dask cluster."""

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
from typing import Any

from gear_kinematics.bag import Bag, BagError, Message, ReportProgress
from gear_kinematics.bag.errors import unexpected
from gear_kinematics.bag.roles import Topics, find_topics
from gear_kinematics.kinematics import MechanismError
from gear_kinematics.report.document import Verdict
from gear_kinematics.validation.output_topics import Tolerances
from gear_kinematics.validation.report import BagReport
from gear_kinematics.validation.validator import Validator

_TRIES = 3
"""How often a bag is begun whose worker dies."""
_CONNECT_TIMEOUT = 10.0  # s
_PATIENCE = 60.0  # s, with a cluster that has no workers
_TOPICS = Topics()


@dataclass(frozen=True, slots=True)
class Task:
    """A bag, and what to validate it with."""

    bag: Path
    parameters: Mapping[str, Any]
    """Of the node, as `parameters.load` gives them."""
    config: str
    """Where they are from."""
    tolerances: Tolerances
    allow_offset: bool = False
    strict: bool = False
    rotor_topic: str | None = None
    """None: found by type and name, and so are the others."""
    output_topic: str | None = None
    poses_topic: str | None = None
    debug: bool = False
    """Whether tracebacks of unexpected errors go to stderr."""


class SchedulerError(ValueError):
    """The Dask cluster cannot be used; the text names it and the cause."""


def validate_bag(
    task: Task,
    progress: ReportProgress | None = None,
    play: Callable[..., Iterable[Message]] | None = None,
) -> BagReport:
    """Validate one bag. Whatever goes wrong with a recording is told in its report.

    Args:
        task: the bag, and what to validate it with.
        progress: told after each batch, with the messages on all topics of the bag.
        play: `replay.live_messages`, to validate what it gives for the rotor topic and not what
            was recorded.

    Raises:
        MechanismError: if the parameters describe no mechanism.
    """
    try:
        with Bag(task.bag) as bag:
            given = {
                'rotor': task.rotor_topic,
                'output': task.output_topic,
                'poses': task.poses_topic,
            }
            topics = find_topics(bag, given, outputs=not play)
            if play:
                messages = play(bag, task.parameters, rotor_topic=topics.rotor)
                # Nothing gets lost on the way to what is recorded here.
                return validate_messages(replace(task, strict=True), messages, progress)
            messages = bag.messages(topics)
            return validate_messages(task, messages, progress, topics, bag.message_count)
    except BagError as error:
        return _unusable(task, str(error))
    except Exception as error:
        if play or isinstance(error, MechanismError):
            raise
        return _unusable(task, f'{task.bag}: {unexpected(error, debug=task.debug)}')


def validate_messages(
    task: Task,
    messages: Iterable[Message],
    progress: ReportProgress | None = None,
    topics: Topics = _TOPICS,
    total: int | None = None,
) -> BagReport:
    """Validate messages of a bag, as far as they can be had; the rest as for `validate_bag`."""
    validator = Validator(
        task.parameters,
        topics=topics,
        tolerances=task.tolerances,
        allow_offset=task.allow_offset,
        strict=task.strict,
    )
    damage = None
    try:
        validator.feed(messages, progress, total)
    except BagError as error:
        damage = str(error)
    return replace(validator.report(str(task.bag), error=damage), config=task.config)


def validate_on_this_machine(tasks: Sequence[Task], jobs: int) -> Iterator[BagReport]:
    """Validate bags in several processes; gives the reports as they come.

    A bag whose process dies is begun again, and is reported as unusable if that goes on.
    """
    left = list(tasks)
    while left:
        lost = []
        for task, report in _in_a_pool(left, jobs):
            if report:
                yield report
            else:
                lost.append(task)
        # A process that dies takes its pool with it. It was at one of the first bags of those
        # that are left; whose fault it was shows when each of them is alone.
        numbers = {id(task): number for number, task in enumerate(left)}
        lost.sort(key=lambda task: numbers[id(task)])
        for task in lost[:jobs]:
            tries = (_in_a_pool([task], jobs=1) for _ in range(_TRIES - 1))
            reports = (report for attempt in tries for _, report in attempt if report)
            yield next(reports, None) or _lost(task)
        left = lost[jobs:]


def _in_a_pool(tasks: Sequence[Task], jobs: int) -> Iterator[tuple[Task, BagReport | None]]:
    """Each bag with its report, or None where a process died."""
    # Forking would copy the threads of a progress bar in whatever state they are.
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
        except BaseException:  # nobody waits for the reports any more
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
    """See to it that nothing is left of a pool whose owner is killed."""
    if parent := multiprocessing.parent_process():
        threading.Thread(target=_end_after, args=[parent], daemon=True).start()


def _end_after(process: BaseProcess) -> None:
    process.join()
    os._exit(1)


@contextmanager
def _interrupts_blocked() -> Iterator[None]:
    """Start processes that Ctrl-C does not reach: it is for the one that ends them."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def _current_folder_shunned() -> Iterator[None]:
    """Start processes, which begin as `python -c`, that import nothing from the current folder."""
    name = 'PYTHONSAFEPATH'
    before = os.environ.get(name, '')  # empty is not set
    os.environ[name] = '1'
    try:
        yield
    finally:
        os.environ[name] = before


def validate_on_cluster(tasks: Sequence[Task], scheduler: str) -> Iterator[BagReport]:
    """Validate bags on a Dask cluster; gives the reports as they come.

    This package is installed where the scheduler and the workers are, and the workers see the
    bags under the same paths. A bag whose worker dies is begun again on another, and is reported
    as unusable if that goes on.

    Args:
        tasks: the bags.
        scheduler: such as tcp://host:8786.

    Raises:
        SchedulerError: if there is no such cluster.
        ModuleNotFoundError: if dask is not installed.
    """
    import distributed  # noqa: PLC0415, an extra

    for name in ('distributed', 'distributed.client'):  # what matters is in the reports
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
        # Dask blames every bag that a dead worker had before it; whose fault it was shows when
        # each is alone.
        for task in lost:
            for _, report in _on_workers(client, [task]):
                yield report or _lost(task)


def _on_workers(client: Any, tasks: Sequence[Task]) -> Iterator[tuple[Task, BagReport | None]]:
    """Each bag with its report, or None where workers died."""
    import distributed  # noqa: PLC0415, an extra

    waiting = {
        # The workers' working directory is another.
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
                except Exception as error:  # noqa: BLE001, of the cluster, not of the bag
                    cause = ' '.join(str(error).split())
                    yield task, _unusable(task, f'{task.bag}: not done by the cluster: {cause}')
        if waiting and not client.scheduler_info()['workers']:
            for task in waiting.values():
                yield task, _unusable(task, f'{task.bag}: the cluster has no workers for it')
            return


def _lost(task: Task) -> BagReport:
    return _unusable(task, f'{task.bag}: lost, because its worker died again and again')


def _unusable(task: Task, error: str) -> BagReport:
    return BagReport(str(task.bag), Verdict.UNUSABLE, config=task.config, error=error)

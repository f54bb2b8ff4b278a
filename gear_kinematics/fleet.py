"""Validating bags: one, many in processes of this machine, or many on a Dask cluster."""

import concurrent.futures
import glob
import logging
import multiprocessing
import os
import re
import signal
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any

from gear_kinematics.bag import Bag, BagError, listed
from gear_kinematics.bag.errors import unexpected
from gear_kinematics.kinematics import MechanismError
from gear_kinematics.messages import JOINT_STATE, POSE_ARRAY
from gear_kinematics.report import BagReport, Verdict
from gear_kinematics.validation import Message, Tolerances, Topics, Validator

_CONTRACT = {
    'output': ('output_state', JOINT_STATE),
    'poses': ('body_poses', POSE_ARRAY),
    'rotor': ('rotor_state', JOINT_STATE),
}
"""Name and type of the topics."""
_OURS = {
    *(name for name, _ in _CONTRACT.values()),
    'mechanism_joint_states',
    'output_encoder',
    'transmission_error',
}
_BAG_FILE = re.compile(r'\.(mcap|db3|bag)(\.(zstd|zst|lz4))?$')
_NUMBER = re.compile(r'_\d+(?=\.(mcap|db3))')
"""Of a file of a split recording."""
_TRIES = 3
"""How often a bag is begun whose worker dies."""
_CONNECT_TIMEOUT = 10.0  # s
_PATIENCE = 60.0  # s, with a cluster that has no workers
_TOPICS = Topics()
Progress = Callable[[int, int | None], None]
"""Messages of a batch, and of the whole bag if that is known."""


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


def find_bags(patterns: Iterable[str]) -> list[Path]:
    """Find the bags that files, directories and globs name; a directory can hold many.

    Raises:
        BagError: naming a pattern that nothing fits.
    """
    found: list[Path] = []
    for pattern in patterns:
        path = Path(pattern)
        bags = list(_bags_below(path)) if path.exists() else list(_glob(pattern))
        if not bags:
            raise BagError(f'{pattern}: no bag there')
        found += bags
    return list(dict.fromkeys(found))


def _glob(pattern: str) -> Iterator[Path]:
    # Path.glob takes no absolute patterns.
    matches = sorted(map(Path, glob.iglob(pattern, recursive=True)))  # noqa: PTH207
    bags = {bag: None for match in matches if _may_hold(match) for bag in _bags_below(match)}
    # `**` also fits the files of the bags that it fits.
    return (bag for bag in bags if bag.parent not in bags)


def _bags_below(path: Path) -> Iterator[Path]:
    if not path.is_dir() or (path / 'metadata.yaml').exists():
        yield path
        return
    children = sorted(
        child for child in path.iterdir() if _may_hold(child) and not _leads_astray(child)
    )
    files = [child for child in children if not child.is_dir()]
    if len(files) > 1 and len({_NUMBER.sub('', file.name) for file in files}) == 1:
        yield path  # a split recording whose recorder was killed
        children = [child for child in children if child.is_dir()]
    for child in children:
        yield from _bags_below(child)


def _leads_astray(path: Path) -> bool:
    """Whether it is a link to a folder that is no bag: links can go round in circles."""
    return path.is_symlink() and path.is_dir() and not (path / 'metadata.yaml').exists()


def _may_hold(path: Path) -> bool:
    return path.is_dir() or bool(_BAG_FILE.search(path.name))


def find_topics(bag: Bag, task: Task | None = None, *, outputs: bool = True) -> Topics:
    """Find the three topics by type and name: as in the contract, in any namespace.

    Those of the namespace of the rotor's topic come first.

    Args:
        bag: an open bag.
        task: may name them.
        outputs: whether those have to be there.

    Raises:
        BagError: if one is not there, or which one is meant is not clear.
    """
    roles = list(_CONTRACT) if outputs else ['rotor']
    given = {role: topic for role in roles if (topic := getattr(task, f'{role}_topic', None))}
    left = dict(bag.topics)
    namespace, _, _ = given.get('rotor', '').rpartition('/')
    for role in roles if 'rotor' in given else ():
        beside = f'{namespace}/{_CONTRACT[role][0]}'
        if bag.topics.get(beside) == _CONTRACT[role][1]:
            given.setdefault(role, beside)
    for role, topic in given.items():
        if left.pop(topic, None) != (kind := _CONTRACT[role][1]):
            raise BagError(f'{bag.path}: no topic {topic} of type {kind} in it')
    for role in roles:
        if role not in given:
            given[role] = _find_topic(bag.path, left, *_CONTRACT[role])
            del left[given[role]]
    return replace(_TOPICS, **given)


def find_rotor_topic(bag: Bag, given: str | None = None) -> str:
    """Give the rotor's topic: the given one, or else by type and name.

    Raises:
        BagError: if it is not there, or which one is meant is not clear.
    """
    if not given:
        return find_topics(bag, outputs=False).rotor
    if bag.topics.get(given) != JOINT_STATE:
        raise BagError(f'{bag.path}: no topic {given} of type {JOINT_STATE} in it')
    return given


def _find_topic(path: Path, available: Mapping[str, str], name: str, kind: str) -> str:
    by_type = {
        topic: topic.rpartition('/')[2]
        for topic, its_kind in sorted(available.items())
        if its_kind == kind
    }
    candidates = [topic for topic, base in by_type.items() if base == name] or [
        topic for topic, base in by_type.items() if base not in _OURS
    ]
    if not candidates:
        raise BagError(f'{path}: no topic {name} of type {kind} in it')
    if len(candidates) > 1:
        raise BagError(f'{path}: which topic is {name}? {listed(candidates)}')
    return candidates[0]


def validate_bag(
    task: Task,
    progress: Progress | None = None,
    play: Callable[..., Iterable[Message]] | None = None,
) -> BagReport:
    """Validate one bag. Whatever goes wrong with a recording is told in its report.

    Args:
        task: the bag, and what to validate it with.
        progress: called with the messages of each batch and of the whole bag, if that is known.
        play: `replay.live_messages`, to validate what it gives for the rotor topic and not what
            was recorded.

    Raises:
        MechanismError: if the parameters describe no mechanism.
    """
    try:
        with Bag(task.bag) as bag:
            topics = find_topics(bag, task, outputs=not play)
            if play:
                messages = play(bag, task.parameters, rotor_topic=topics.rotor)
                # Nothing gets lost on the way to what is recorded here.
                return validate_messages(replace(task, strict=True), messages, progress)
            messages = bag.messages(topics.names())
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
    progress: Progress | None = None,
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
        validator.feed(messages, progress and (lambda count: progress(count, total)))
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

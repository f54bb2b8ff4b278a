"""Validates a bag, in this process, another one or on a Dask cluster."""

import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path

from gear_kinematics.bag import Bag, BagError, Message, ReportProgress, fleet, in_batches
from gear_kinematics.bag.errors import unexpected
from gear_kinematics.bag.roles import (
    Topics,
    corrected_beside,
    find_corrected_topics,
    find_topics,
    only_joint,
)
from gear_kinematics.bag.schedule import count_due
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import Verdict
from gear_kinematics.validation.report import BagReport, Finding
from gear_kinematics.validation.task import Task
from gear_kinematics.validation.validator import Validator
from gear_kinematics.wire.joint_reader import JOINT_MISSING

_BATCH = 8192  # messages of a live node that are validated together


def validate_bag(
    task: Task,
    progress: ReportProgress | None = None,
    play: Callable[..., Iterable[Message]] | None = None,
) -> BagReport:
    """Validate one bag; the report contains any error about the recording.

    Args:
        task: the bag, and how to validate it.
        progress: called after each batch; the total counts all topics of the bag, or with `play`
            the rotor's alone.
        play: `live_messages`, to validate the outputs of a live node instead of recorded ones.

    Raises:
        MechanismError: if the parameters describe no mechanism.
    """
    begun = time.monotonic()
    report = _validated(task, progress, play)
    return replace(report, elapsed=time.monotonic() - begun)


def _validated(
    task: Task,
    progress: ReportProgress | None = None,
    play: Callable[..., Iterable[Message]] | None = None,
) -> BagReport:
    poses = isinstance(task.parameters.gear, Mechanism)
    given = {'rotor': task.rotor_topic, 'output': task.output_topic, 'poses': task.poses_topic}
    joint = task.parameters.rotor_joint
    try:
        with Bag(task.bag) as bag:
            topics = find_topics(bag, given, outputs=not play, poses=poses, joint=joint)
            if play:
                task = replace(task, parameters=_of_only_joint(task, bag, topics.rotor))
                return _validate_live(task, bag, topics.rotor, progress, play)
            report = _validate(task, bag, topics, progress)
            if report.rotor and report.rotor.rejected.get(JOINT_MISSING) == report.rotor.messages:
                parameters = _of_only_joint(task, bag, topics.rotor)
                if parameters.rotor_joint != joint:
                    report = _validate(replace(task, parameters=parameters), bag, topics, progress)
                    text = f'{parameters.rotor_joint}, the only joint on {topics.rotor}, is taken'
                    report = replace(report, findings=(Finding(text), *report.findings))
            return report
    except BagError as error:
        return unusable(task.bag, str(error), task.config)
    except Exception as error:
        if play and not isinstance(error, RuntimeError):  # of the live node
            raise
        cause = str(error) if play else unexpected(error, debug=task.debug)
        return _lost(task, cause)


def _of_only_joint(task: Task, bag: Bag, rotor: str) -> NodeParameters:
    """Return the parameters with the only joint on the rotor's topic, if theirs is not there."""
    joint = task.parameters.rotor_joint
    found = only_joint(bag, rotor, joint) if task.only_joint else joint
    return replace(task.parameters, rotor_joint=found)


def _validate(task: Task, bag: Bag, topics: Topics, progress: ReportProgress | None) -> BagReport:
    corrected = find_corrected_topics(bag, topics.output)
    batches = bag.batches((*topics, *corrected.values()), progress)
    return _report(Validator(task, topics, corrected), batches)


def _validate_live(
    task: Task,
    bag: Bag,
    rotor: str,
    progress: ReportProgress | None,
    play: Callable[..., Iterable[Message]],
) -> BagReport:
    """Validate what a live node publishes on its own topics for the rotor states of a bag."""
    total = count_due(bag, [rotor]) if progress else None
    messages = play(
        bag,
        replace(task.parameters, calibration=task.calibration_file),
        rotor_topic=rotor,
        progress=lambda sent, _: progress and progress(sent, total),
    )
    # Nothing is lost by a recorder here.
    task = replace(task, strict=True)
    corrected = corrected_beside() if task.calibration else {}
    return _report(Validator(task, corrected=corrected), in_batches(messages, _BATCH))


def _report(validator: Validator, batches: Iterable[Sequence[Message]]) -> BagReport:
    """Validate the readable messages of a bag."""
    try:
        validator.feed(batches)
    except BagError as error:
        return validator.report(str(error))
    return validator.report()


def _absolute(task: Task) -> Task:
    return replace(task, bag=task.bag.absolute())


def _lost(task: Task, cause: str) -> BagReport:
    return unusable(task.bag, f'{task.bag}: {cause}', task.config)


def unusable(bag: Path, error: str, config: str = '') -> BagReport:
    """Return the report on a bag that cannot be validated, and why; `config` is its file."""
    return BagReport(str(bag), Verdict.UNUSABLE, config=config, error=error)


WORK = fleet.Work(validate_bag, _lost, _absolute)
"""For `fleet.on_this_machine` and `fleet.on_cluster`."""

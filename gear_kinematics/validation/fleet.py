"""Validates a bag, in this process, another one or on a Dask cluster."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from gear_kinematics.bag import Bag, BagError, Message, ReportProgress, fleet
from gear_kinematics.bag.errors import unexpected
from gear_kinematics.bag.roles import (
    Topics,
    corrected_beside,
    find_corrected_topics,
    find_topics,
)
from gear_kinematics.bag.schedule import count_due
from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import Verdict
from gear_kinematics.validation.output_topics import Tolerances
from gear_kinematics.validation.report import BagReport
from gear_kinematics.validation.validator import Validator

_TOPICS = Topics()


@dataclass(frozen=True, slots=True)
class Task:
    """A bag, and how to validate it."""

    bag: Path
    parameters: NodeParameters
    """Parameters of the node."""
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
    poses = isinstance(task.parameters.gear, Mechanism)
    try:
        with Bag(task.bag) as bag:
            given = {
                'rotor': task.rotor_topic,
                'output': task.output_topic,
                'poses': task.poses_topic,
            }
            joint = task.parameters.rotor_joint
            topics = find_topics(bag, given, outputs=not play, poses=poses, joint=joint)
            if play:
                total = count_due(bag, [topics.rotor]) if progress else None
                messages = play(
                    bag,
                    replace(task.parameters, calibration=task.calibration_file),
                    rotor_topic=topics.rotor,
                    progress=lambda sent, _: progress and progress(sent, total),
                )
                corrected = corrected_beside() if task.calibration else {}
                # Nothing is lost by a recorder here.
                task = replace(task, strict=True)
                return validate_messages(task, messages, corrected)
            corrected = find_corrected_topics(bag, topics.output)
            messages = bag.messages((*topics, *corrected.values()))
            return validate_messages(
                task, messages, corrected, progress, topics, bag.message_count
            )
    except BagError as error:
        return unusable(task.bag, str(error), task.config)
    except Exception as error:
        if play and not isinstance(error, RuntimeError):  # of the live node
            raise
        cause = str(error) if play else unexpected(error, debug=task.debug)
        return unusable(task.bag, f'{task.bag}: {cause}', task.config)


def validate_messages(
    task: Task,
    messages: Iterable[Message],
    corrected: Mapping[str, str],
    progress: ReportProgress | None = None,
    topics: Topics = _TOPICS,
    total: int | None = None,
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
    findings = []
    if report.mechanism and not topics.poses:
        findings.append(f'no poses are recorded: {topics.output} alone is compared')
    if validator.judges_correction:
        findings.append(f'the corrected output is compared with that of {task.calibration_file}')
    return replace(report, config=task.config, findings=(*findings, *report.findings))


def _absolute(task: Task) -> Task:
    return replace(task, bag=task.bag.absolute())


def _lost(task: Task, cause: str) -> BagReport:
    return unusable(task.bag, f'{task.bag}: {cause}', task.config)


def unusable(bag: Path, error: str, config: str = '') -> BagReport:
    """Return the report on a bag that cannot be validated, and why; `config` is its file."""
    return BagReport(str(bag), Verdict.UNUSABLE, config=config, error=error)


WORK = fleet.Work(validate_bag, _lost, _absolute)
"""For `fleet.on_this_machine` and `fleet.on_cluster`."""

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Validates a bag, in this process, another one or on a Dask cluster."""

import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from gear_kinematics.bag import Bag, BagError, Message, ReportProgress, fleet, in_batches
from gear_kinematics.bag.errors import unexpected
from gear_kinematics.bag.roles import (
    Topics,
    corrected_beside,
    encoder_beside,
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
from gear_kinematics.wire.topics import OUTPUT_ENCODER

_BATCH = 8192  # messages of a live node that are validated together


def validate(
    bag: Path | str, parameters: NodeParameters | Path | str, **options: Any
) -> BagReport:
    """Validate a bag, as in a test of another package.

    Args:
        bag: a file or a folder.
        parameters: of the node, or their file.
        options: further fields of `Task`, as the options of `gearkin validate`.

    Raises:
        ConfigError: if the file cannot be used.
        MechanismError: if the parameters describe no mechanism.
    """
    if not isinstance(parameters, NodeParameters):
        options.setdefault('config', str(parameters))
        parameters = NodeParameters.load(Path(parameters))
    return validate_bag(Task(Path(bag), parameters, **options))


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
    try:
        with Bag(task.bag) as bag:
            report = _live(task, bag, progress, play) if play else _recorded(task, bag, progress)
    except BagError as error:
        report = unusable(task.bag, str(error), task.config)
    except Exception as error:
        if play and not isinstance(error, RuntimeError):  # of the live node
            raise
        report = _lost(task, str(error) if play else unexpected(error, debug=task.debug))
    return replace(report, elapsed=time.monotonic() - begun)


def _topics(task: Task, bag: Bag, *, outputs: bool) -> Topics:
    return find_topics(
        bag,
        {'rotor': task.rotor_topic, 'output': task.output_topic, 'poses': task.poses_topic},
        outputs=outputs,
        poses=isinstance(task.parameters.gear, Mechanism),
        joint=task.parameters.rotor_joint,
    )


def _with_only_joint(task: Task, bag: Bag, rotor: str) -> Task:
    """Return the task with the only joint on the rotor's topic, if its own is not there."""
    joint = task.parameters.rotor_joint
    found = only_joint(bag, rotor, joint) if task.only_joint and joint else joint
    return replace(task, parameters=replace(task.parameters, rotor_joint=found))


def _recorded(task: Task, bag: Bag, progress: ReportProgress | None) -> BagReport:
    """Validate the recorded outputs."""
    topics = _topics(task, bag, outputs=True)
    corrected = find_corrected_topics(bag, topics.output)
    encoder = encoder_beside(bag, topics.rotor) if task.parameters.absolute else ''
    names = (*topics, *corrected.values(), *filter(None, [encoder]))
    judged = _with_only_joint(task, bag, topics.rotor)
    validator = Validator(judged, topics, corrected, encoder=encoder)
    report = _report(validator, bag.batches(names, progress))
    if judged != task:
        joint = judged.parameters.rotor_joint
        taken = Finding(f'{joint}, the only joint on {topics.rotor}, is taken')
        report = replace(report, findings=(taken, *report.findings))
    return report


def _live(
    task: Task,
    bag: Bag,
    progress: ReportProgress | None,
    play: Callable[..., Iterable[Message]],
) -> BagReport:
    """Validate what a live node publishes on its own topics for the rotor states of a bag."""
    rotor = _topics(task, bag, outputs=False).rotor
    encoder = encoder_beside(bag, rotor) if task.parameters.absolute else ''
    total = count_due(bag, [rotor]) if progress else None
    # Nothing is lost by a recorder here.
    task = replace(_with_only_joint(task, bag, rotor), strict=True)
    messages = play(
        bag,
        task.parameters,
        rotor_topic=rotor,
        encoder_topic=encoder,
        progress=lambda sent, _: progress and progress(sent, total),
    )
    corrected = corrected_beside() if task.calibration else {}
    validator = Validator(task, corrected=corrected, encoder=encoder and f'/{OUTPUT_ENCODER}')
    return _report(validator, in_batches(messages, _BATCH))


def _report(validator: Validator, batches: Iterable[Sequence[Message]]) -> BagReport:
    """Validate the readable messages of a bag."""
    try:
        validator.feed(batches)
    except BagError as error:
        return validator.report(str(error))
    return validator.report()


def _lost(task: Task, cause: str) -> BagReport:
    return unusable(task.bag, f'{task.bag}: {cause}', task.config)


def unusable(bag: Path, error: str, config: str = '') -> BagReport:
    """Return the report on a bag that cannot be validated, and why; `config` is its file."""
    return BagReport(str(bag), Verdict.UNUSABLE, config=config, error=error)


WORK = fleet.Work(validate_bag, _lost, lambda task: replace(task, bag=task.bag.absolute()))
"""For `fleet.on_this_machine` and `fleet.on_cluster`."""

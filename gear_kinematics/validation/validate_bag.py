# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Validates a bag, in this process or another one."""

import time
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import Any

from gear_kinematics.bag import Bag, BagError, Message, MessagesByTopic, ReportProgress, in_batches
from gear_kinematics.bag.errors import unexpected
from gear_kinematics.bag.roles import (
    Topics,
    find_encoder_topic,
    find_in_namespace,
    find_topics,
    in_namespace,
    joints_on,
    only_joint,
)
from gear_kinematics.bag.schedule import count_due
from gear_kinematics.fleet.processes import Work
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.parameters.arm import load_actuators
from gear_kinematics.report.document import Verdict
from gear_kinematics.validation.arm import ArmValidator
from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.independent import Independent
from gear_kinematics.validation.report import BagReport, Finding, unusable
from gear_kinematics.validation.task import Task
from gear_kinematics.validation.validator import Validator, agrees
from gear_kinematics.wire.cdr import MalformedMessageError, messages_lost
from gear_kinematics.wire.topics import (
    BODY_POSES,
    CORRECTED_TOPICS,
    JOINT_STATES,
    LOAD_TOPICS,
    OUTPUT_ENCODER,
    TOPICS,
    base_name,
    topic_of,
)

_LOSSES = 'rosbag2_interfaces/msg/MessagesLostEvent'  # of recorders since Lyrical
_OF_BODIES = JOINT_STATES, *LOAD_TOPICS  # further topics, if the bodies of the gear are known
_BATCH = 8192  # messages of a live node that are validated together


def validate(
    bag: Path | str, parameters: NodeParameters | Path | str, **options: Any
) -> BagReport:
    """Validate a bag, as in a test of another package; `options` are further fields of `Task`.

    Raises:
        ConfigError: if the parameter file cannot be used.
        MechanismError: if the parameters describe no mechanism.
    """
    if isinstance(parameters, NodeParameters):
        actuators = {parameters.actuator: parameters}
    else:
        options.setdefault('config', str(parameters))
        actuators = load_actuators(Path(parameters))
    return validate_bag(of_arm([Task(Path(bag), each, **options) for each in actuators.values()]))


def of_arm(tasks: Sequence[Task]) -> Task:
    """Return the task of a single gear, or join the tasks of an arm's actuators in one."""
    first, *_ = tasks
    return replace(first, actuators=tuple(tasks)) if first.parameters.actuator else first


def validate_bag(
    task: Task,
    progress: ReportProgress | None = None,
    play: Callable[..., Iterable[Message]] | None = None,
) -> BagReport:
    """Validate one bag; the report contains any error about the recording.

    `play` is `live_messages`, to validate the outputs of a live node instead of recorded ones.
    The total in `progress` then counts the rotor's messages, instead of all in the bag.

    Raises:
        MechanismError: if the parameters describe no mechanism.
    """
    begun = time.monotonic()
    try:
        with Bag(task.bag) as bag:
            if task.actuators:
                report = _judged_arm(task, bag, progress)
            else:
                report = _judged(task, bag, progress, play)
    except BagError as error:
        report = unusable(task.bag, str(error), task.config)
    except Exception as error:
        if play and not isinstance(error, RuntimeError):  # of the live node
            raise
        cause = str(error) if play else unexpected(error, debug=task.debug)
        report = _lost(task, cause)
    return replace(report, elapsed=time.monotonic() - begun)


def _judged(
    task: Task,
    bag: Bag,
    progress: ReportProgress | None,
    play: Callable[..., Iterable[Message]] | None,
) -> BagReport:
    """Validate what is recorded, or what a live node publishes for the recorded rotor states."""
    joint, known = task.parameters.rotor_joint, isinstance(task.parameters.gear, Mechanism)
    topics = find_topics(
        bag,
        {'rotor': task.rotor_topic, 'output': task.output_topic, 'poses': task.poses_topic},
        outputs=not play,
        poses=known,
        joints=[joint],
        namespace=task.namespace,
    )
    encoder = find_encoder_topic(bag, topics.rotor) if task.parameters.absolute else ''
    found = only_joint(bag, topics.rotor, joint) if task.only_joint and joint else joint
    task = replace(task, parameters=replace(task.parameters, rotor_joint=found))
    names: Sequence[str] = ()
    batches: Iterable[MessagesByTopic]
    if play:
        total = count_due(bag, [topics.rotor]) if progress else None
        messages = play(
            bag,
            task.parameters,
            rotor_topic=topics.rotor,
            encoder_topic=encoder,
            progress=lambda sent, _: progress and progress(sent, total),
        )
        further = in_namespace(CORRECTED_TOPICS) if task.calibration else {}
        live = replace(task, strict=True)  # nothing is lost by a recorder here
        own = Topics() if known else Topics(poses='')
        validator = Validator(live, own, further, encoder=encoder and f'/{OUTPUT_ENCODER}')
        lists = in_batches(messages, _BATCH)
        batches = (MessagesByTopic(validator.topics, messages) for messages in lists)
    else:
        judged = *CORRECTED_TOPICS, *(_OF_BODIES if known else ())
        further = find_in_namespace(bag, judged, topics.output)
        names = (*topics, *further.values(), *filter(None, [encoder]))
        if not known:  # poses are not judged, which is said
            poses = find_in_namespace(bag, [BODY_POSES], topics.output)
            topics = topics._replace(poses=poses.get(BODY_POSES, ''))
        validator = Validator(task, topics, further, encoder=encoder)
        batches = bag.by_topic(names, progress)
    proof = Independent(task, Topics() if play else topics) if task.independent else None
    damage = None
    try:
        validator.feed(_seen(proof, batches) if proof else batches)
    except BagError as error:
        damage = str(error)
    lost = Counter[str]() if play else _recorded_losses(bag)
    report = with_proof(validator.report(damage, lost), proof).adding(*_losses(lost, names))
    if found != joint:
        taken = Finding(FindingCause.ONLY_JOINT, values={'joint': found, 'topic': topics.rotor})
        report = replace(report, findings=(taken, *report.findings))
    elif not play:
        report = _explained(report, task, bag, topics)
    return report if play else report.adding(*_not_compared(bag, topics, validator.topics))


def _judged_arm(task: Task, bag: Bag, progress: ReportProgress | None) -> BagReport:
    """Validate what is recorded of several actuators."""
    topics = find_topics(
        bag,
        {'rotor': task.rotor_topic, 'output': task.output_topic},
        poses=False,
        joints=[each.parameters.rotor_joint for each in task.actuators],
        namespace=task.namespace,
    )
    namespace, _, _ = topics.output.rpartition('/')
    validators, proofs = list[Validator](), list[Independent | None]()
    for each in task.actuators:
        parameters = each.parameters
        bodies = _OF_BODIES if isinstance(parameters.gear, Mechanism) else ()
        names = {
            name: f'{namespace}/{topic_of(parameters.actuator, name)}'
            for name in (BODY_POSES, *CORRECTED_TOPICS, *bodies)
        }
        own = {n: topic for n, topic in names.items() if bag.topics.get(topic) == TOPICS[n].type}
        of = topics._replace(poses=each.poses_topic or own.pop(BODY_POSES, ''))
        encoder = find_encoder_topic(bag, topics.rotor) if parameters.absolute else ''
        validators.append(Validator(each, of, own, encoder=encoder))
        proofs.append(Independent(each, of) if task.independent else None)
    arm, damage = ArmValidator(validators), None
    recorded = sorted(arm.topics - {''})
    batches: Iterable[MessagesByTopic] = bag.by_topic(recorded, progress)
    for proof in filter(None, proofs):
        batches = _seen(proof, batches)
    try:
        arm.feed(batches)
    except BagError as error:
        damage = str(error)
    lost = _recorded_losses(bag)
    reports = [
        _explained(with_proof(report, proof), each, bag, topics)
        for report, proof, each in zip(
            arm.reports(damage, lost), proofs, task.actuators, strict=True
        )
    ]
    actuators = [each.parameters.actuator for each in task.actuators]
    left_out = _not_compared(bag, topics, recorded, *actuators)
    return arm.report(task, reports).adding(*_losses(lost, recorded), *left_out)


def _explained(report: BagReport, task: Task, bag: Bag, topics: Topics) -> BagReport:
    """Add whose outputs they are, if wrong ones agree with another joint of the rotor's topic."""
    joint, found = task.parameters.rotor_joint, list[Finding]()
    wrong = any(topic.wrong for topic in report.topics)
    for other in joints_on(bag, [topics.rotor])[topics.rotor] if wrong else ():
        of_other = replace(task, parameters=replace(task.parameters, rotor_joint=other))
        if other != joint and agrees(of_other, topics, islice(bag.by_topic(topics), 1)):
            actuator = task.parameters.actuator
            cause = FindingCause.OTHER_ROTOR if actuator else FindingCause.OTHER_JOINT
            values = {'joint': joint, 'other': other, 'actuator': actuator}
            found.append(Finding(cause, values=values, explains=True))
            break
    return replace(report, findings=(*found, *report.findings))


def _losses(lost: Counter[str], topics: Iterable[str]) -> Iterator[Finding]:
    """Yield what the recorder says that it lost of topics."""
    for topic in topics:
        if lost[topic]:
            yield Finding(FindingCause.RECORDER_LOST, topic, count=lost[topic])


def _not_compared(
    bag: Bag, topics: Topics, compared: Collection[str], *actuators: str
) -> Iterator[Finding]:
    """Yield which recorded topics of the node are not compared."""
    names = {
        topic_of(actuator, name): topic.type
        for actuator in ('', *actuators)
        for name, topic in TOPICS.items()
        if topic.publisher == 'node'
    }
    own = zip(in_namespace(names, topics.output).values(), names.values(), strict=True)
    recorded = (topic for topic, kind in own if bag.topics.get(topic) == kind)
    if left := dict.fromkeys(base_name(topic) for topic in recorded if topic not in compared):
        yield Finding(FindingCause.NOT_COMPARED, values={'topics': list(left)})


def _recorded_losses(bag: Bag) -> Counter[str]:
    """Count the messages that the recorder says that it lost, by topic, where this is recorded."""
    events = [name for name, kind in bag.topics.items() if kind == _LOSSES]
    lost: Counter[str] = Counter()
    with suppress(BagError, MalformedMessageError):
        for _, _, data in bag.messages(events) if events else ():
            lost += messages_lost(data)
    return lost


def _seen(proof: Independent, batches: Iterable[MessagesByTopic]) -> Iterator[MessagesByTopic]:
    """Pass messages on after an independent comparison has taken them."""
    for batch in batches:
        proof.take(batch)
        yield batch


def with_proof(report: BagReport, proof: Independent | None) -> BagReport:
    """Add what an independent comparison has found."""
    if not proof or report.verdict == Verdict.UNUSABLE:
        return report
    found = proof.report()
    finding = Finding(
        FindingCause.INDEPENDENT,
        stamp=found.first_wrong,
        values={'independent': found},
        fails=not found.passed,
    )
    return replace(report, independent=found).adding(finding)


def _lost(task: Task, cause: str) -> BagReport:
    return unusable(task.bag, f'{task.bag}: {cause}', task.config)


WORK = Work(validate_bag, _lost)  #: for `fleet.processes`

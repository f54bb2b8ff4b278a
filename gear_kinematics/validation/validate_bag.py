# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Validates a bag, in this process or another one."""

import time
from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import compress, islice
from operator import eq
from pathlib import Path
from typing import Any

from gear_kinematics.bag import (
    Bag,
    BagError,
    Message,
    MessagesByTopic,
    ReportProgress,
    TopicMessages,
    in_batches,
)
from gear_kinematics.bag.errors import unexpected
from gear_kinematics.bag.roles import (
    Topics,
    find_encoder_topic,
    find_in_namespace,
    find_topics,
    in_namespace,
    joints_on,
    only_joint,
    topic_with_joint,
)
from gear_kinematics.bag.schedule import count_due
from gear_kinematics.fleet.processes import Work
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.parameters.arm import load_actuators
from gear_kinematics.validation.arm import ArmValidator
from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.report import BagReport, Finding, unusable
from gear_kinematics.validation.task import Task
from gear_kinematics.validation.validator import Validator
from gear_kinematics.wire.cdr import STAMP_BYTES, MalformedMessageError, messages_lost
from gear_kinematics.wire.topics import (
    BODY_POSES,
    CORRECTED_TOPICS,
    JOINT_STATES,
    LOAD_TOPICS,
    OUTPUT_ENCODER,
    TOPICS,
    TRANSMISSION_ERROR,
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
            report = _played(task, bag, progress, play) if play else _judged(task, bag, progress)
    except BagError as error:
        report = unusable(task.bag, str(error), task.config)
    except Exception as error:
        if play and not isinstance(error, RuntimeError):  # of the live node
            raise
        cause = str(error) if play else unexpected(error, debug=task.debug)
        report = _lost(task, cause)
    return replace(report, elapsed=time.monotonic() - begun)


def _judged(task: Task, bag: Bag, progress: ReportProgress | None) -> BagReport:
    """Validate what is recorded of one gear, or of the actuators of an arm."""
    topics = find_topics(
        bag,
        {'rotor': task.rotor_topic, 'output': task.output_topic, 'poses': task.poses_topic},
        poses=not task.actuators and isinstance(task.parameters.gear, Mechanism),
        joints=[each.parameters.rotor_joint for each in task.actuators or (task,)],
        namespace=task.namespace,
    )
    own, taken = (task, ()) if task.actuators else _of_only_joint(task, bag, topics.rotor)
    tasks = task.actuators or (own,)
    validators = [_validator(each, bag, topics) for each in tasks]
    arm = ArmValidator(validators) if task.actuators else None
    known = {topic for each in validators for topic in each.topics}
    judged = sorted(known.difference(each.unjudged for each in validators))
    twice = list[Finding]()
    batches = _once(bag.by_topic(judged, progress), topics.rotor, twice)
    damage = _feed(arm or validators[0], batches)
    lost = _recorded_losses(bag)
    reports = arm.reports(damage, lost) if arm else [validators[0].report(damage, lost)]
    reports = [
        _explained(report, each, bag, topics) for report, each in zip(reports, tasks, strict=True)
    ]
    report = arm.report(task, reports) if arm else reports[0]
    report = replace(report, findings=(*taken, *report.findings))
    if not any(each.errors and each.errors.compared for each in validators):
        known -= {each.further.get(TRANSMISSION_ERROR, '') for each in validators}
    actuators = [each.parameters.actuator for each in tasks]
    left_out = _not_compared(bag, topics, known, actuators)
    unclosed = [Finding(FindingCause.NOT_CLOSED)] if bag.unclosed else []
    losses = (Finding(FindingCause.RECORDER_LOST, of, count=lost[of]) for of in judged if lost[of])
    return report.adding(*unclosed, *twice, *losses, *left_out)


def _validator(task: Task, bag: Bag, topics: Topics) -> Validator:
    """Prepare the validation of a gear by what is recorded of it."""
    parameters = task.parameters
    bodies = _OF_BODIES if isinstance(parameters.gear, Mechanism) else ()
    judged = BODY_POSES, *CORRECTED_TOPICS, TRANSMISSION_ERROR, *bodies
    names = {topic_of(parameters.actuator, name): name for name in judged}
    found = find_in_namespace(bag, names, topics.output)
    further = {names[own]: topic for own, topic in found.items()}
    if parameters.actuator and not task.calibration:  # in the messages of others
        corrected = joints_on(bag, [further[name] for name in CORRECTED_TOPICS if name in further])
        others = {t for t, joints in corrected.items() if parameters.output_name not in joints}
        further = {name: topic for name, topic in further.items() if topic not in others}
    poses = further.pop(BODY_POSES, '')
    topics = topics._replace(poses=topics.poses or task.poses_topic or poses)
    encoder, joint = '', parameters.distinct_encoder_joint
    near = find_in_namespace(bag, [OUTPUT_ENCODER], topics.output).get(OUTPUT_ENCODER)
    if parameters.absolute or task.encoder_topic or (near and TRANSMISSION_ERROR in further):
        encoder = find_encoder_topic(bag, topics.rotor, task.encoder_topic or near, joint)
    elif TRANSMISSION_ERROR in further:
        encoder = topic_with_joint(bag, topics.rotor, joint)
    return Validator(task, topics, further, encoder=encoder)


def _feed(validator: Validator | ArmValidator, batches: Iterable[MessagesByTopic]) -> str | None:
    """Feed messages, up to any damage, which is returned."""
    try:
        for batch in batches:
            validator.take(batch)
    except BagError as error:
        return str(error)
    return None


def _of_only_joint(task: Task, bag: Bag, rotor: str) -> tuple[Task, Sequence[Finding]]:
    """Take the only joint on the rotor's topic, if the task allows it, and say so."""
    joint = task.parameters.rotor_joint
    found = only_joint(bag, rotor, joint) if task.only_joint and joint else joint
    if found == joint:
        return task, ()
    taken = Finding(FindingCause.ONLY_JOINT, values={'joint': found, 'topic': rotor})
    return replace(task, parameters=replace(task.parameters, rotor_joint=found)), (taken,)


def _played(
    task: Task, bag: Bag, progress: ReportProgress | None, play: Callable[..., Iterable[Message]]
) -> BagReport:
    """Validate what a live node publishes for the recorded rotor states."""
    given, joints = {'rotor': task.rotor_topic}, [task.parameters.rotor_joint]
    rotor, *_ = find_topics(bag, given, outputs=False, joints=joints, namespace=task.namespace)
    encoder, joint = '', task.parameters.distinct_encoder_joint
    if task.parameters.absolute or task.encoder_topic:
        encoder = find_encoder_topic(bag, rotor, task.encoder_topic, joint)
    task, taken = _of_only_joint(task, bag, rotor)
    total = count_due(bag, [rotor]) if progress else None
    messages = play(
        bag,
        task.parameters,
        rotor_topic=rotor,
        encoder_topic=encoder,
        progress=lambda sent, _: progress and progress(sent, total),
    )
    further = in_namespace(CORRECTED_TOPICS) if task.calibration else {}
    topics = Topics() if isinstance(task.parameters.gear, Mechanism) else Topics(poses='')
    strict = replace(task, strict=True)  # nothing is lost by a recorder here
    validator = Validator(strict, topics, further, encoder=encoder and f'/{OUTPUT_ENCODER}')
    batches = in_batches(messages, _BATCH)
    damage = _feed(validator, (MessagesByTopic(validator.topics, batch) for batch in batches))
    report = validator.report(damage)
    return replace(report, findings=(*taken, *report.findings))


def _explained(report: BagReport, task: Task, bag: Bag, topics: Topics) -> BagReport:
    """Add whose outputs they are, if wrong ones agree with another joint of the rotor's topic."""
    if not any(topic.wrong for topic in report.topics):
        return report
    joint, actuator = task.parameters.rotor_joint, task.parameters.actuator
    begin = [*islice(bag.by_topic(topics), 1)]
    for other in joints_on(bag, [topics.rotor])[topics.rotor]:
        of_other = replace(task, parameters=replace(task.parameters, rotor_joint=other))
        if other != joint and _agrees(replace(of_other, independent=False), topics, begin):
            cause = FindingCause.OTHER_ROTOR if actuator else FindingCause.OTHER_JOINT
            values = {'joint': joint, 'other': other, 'actuator': actuator}
            found = Finding(cause, values=values, explains=True)
            return replace(report, findings=(found, *report.findings))
    return report


def _agrees(task: Task, topics: Topics, batches: Iterable[MessagesByTopic]) -> bool:
    """Return whether the outputs in batches agree with a task."""
    validator = Validator(task, topics)
    _feed(validator, batches)
    judged = validator.report().topics
    return bool(judged) and judged[0].compared > 0 and not judged[0].wrong


def _once(
    batches: Iterable[MessagesByTopic], rotor: str, twice: list[Finding]
) -> Iterator[MessagesByTopic]:
    """Drop the second ones of equal messages, where those of the rotor are there twice.

    Outputs that are there twice without their inputs were published twice. At the end it adds how
    many of the rotor's there are to `twice`.
    """
    latest, count = defaultdict[str, tuple[int, bytes]](lambda: (-1, b'')), 0
    for batch in batches:
        new = {rotor: _differs(latest[rotor], batch[rotor])}
        count += new[rotor].count(False)
        if not all(new[rotor]):
            new = {topic: _differs(latest[topic], messages) for topic, messages in batch.items()}
        latest |= {topic: (of.received[-1], of.data[-1]) for topic, of in batch.items() if of.data}
        for topic, rows in new.items():
            if not all(rows):
                batch[topic].received[:] = compress(batch[topic].received, rows)
                batch[topic].data[:] = compress(batch[topic].data, rows)
        yield batch
    twice += [Finding(FindingCause.TWICE, rotor, count=count)] if count else []


def _differs(before: tuple[int, bytes], messages: TopicMessages) -> list[bool]:
    """Return which messages differ from the one before, in stamp, contents or time of reception.

    Messages without a stamp can be equal although each was published, as at rest.
    """
    last, content = before
    received, data = messages.received, messages.data
    if not any(map(eq, [last, *received], received)):
        return []
    rows = zip([last, *received], received, [content, *data], data, strict=False)
    return [a < b or c != d or not any(d[STAMP_BYTES]) for a, b, c, d in rows]


def _not_compared(
    bag: Bag, topics: Topics, known: Collection[str], actuators: Iterable[str]
) -> Iterator[Finding]:
    """Yield which recorded topics of the node are not compared, of which nothing else is said."""
    names = {
        topic_of(actuator, name): topic.type
        for actuator in ('', *actuators)
        for name, topic in TOPICS.items()
        if topic.publisher == 'node'
    }
    own = zip(in_namespace(names, topics.output).values(), names.values(), strict=True)
    recorded = (topic for topic, kind in own if bag.topics.get(topic) == kind)
    if left := dict.fromkeys(base_name(topic) for topic in recorded if topic not in known):
        yield Finding(FindingCause.NOT_COMPARED, values={'topics': list(left)})


def _recorded_losses(bag: Bag) -> Counter[str]:
    """Count the messages that the recorder says that it lost, by topic, where this is recorded."""
    events = [name for name, kind in bag.topics.items() if kind == _LOSSES]
    lost: Counter[str] = Counter()
    with suppress(BagError, MalformedMessageError):
        for _, _, data in bag.messages(events) if events else ():
            lost += messages_lost(data)
    return lost


def _lost(task: Task, cause: str) -> BagReport:
    return unusable(task.bag, f'{task.bag}: {cause}', task.config)


WORK = Work(validate_bag, _lost)  #: for `fleet.processes`

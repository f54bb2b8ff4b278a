# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""All that is wrong with a recording, in sentences."""

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace

from gear_kinematics.report import document
from gear_kinematics.report.document import counted, number, printable
from gear_kinematics.validation.recorder import AFTER, BEFORE, LOST, NO_INPUT
from gear_kinematics.validation.report import BagReport, FieldReport, Finding, TopicReport
from gear_kinematics.validation.task import QUANTITIES

_FIRST = 'the first at'
_SKIPPED = {
    BEFORE: 'the recording had just begun',
    AFTER: 'the recording ended first',
    NO_INPUT: 'their input was not recorded',
    LOST: 'the recorder says that it lost them',
}


def findings(report: BagReport) -> list[document.Sentence]:
    """Return all that is wrong with a bag: its damage, its faults by gravity, and the rest.

    Wrong numbers come before missing messages, a cause before its effects.
    """
    damage = [] if report.error is None else [document.Sentence('error', printable(report.error))]
    notes = [finding for finding in report.findings if not (finding.fails or finding.cause)]
    wrong = sorted((*report.causes, *faults(report)), key=lambda found: found.missing)
    return damage + [
        document.Sentence(
            'finding',
            printable(f'{found.topic}: ' if found.topic else '') + described(found, report),
            None if found.stamp is None else report.seconds(found.stamp),
        )
        for found in (*wrong, *notes, *_left_out(report))
    ]


def explain(report: BagReport) -> str:
    """Return all that is wrong with a bag, a line each."""
    return '\n'.join(found.text for found in findings(report))


def described(found: Finding, report: BagReport) -> str:
    """Write a finding with its moment, without its topic."""
    if found.stamp is None or not found.when:
        return printable(found.text)
    time = report.seconds(found.stamp)
    moment = f'stamp {found.stamp}' if time is None else f'{time:+.3f} s'
    return printable(f'{found.text}, {found.when} {moment}')


def answer(report: BagReport) -> str:
    """Return in one line how much was compared, and the largest error beside its tolerance."""
    if not report.rotor:
        return ''
    outputs = sum(topic.compared for topic in report.topics)
    wrong = sum(topic.wrong for topic in report.topics)
    compared = counted(outputs, 'output')
    judged = f'{wrong} of {compared} wrong' if wrong else f'{compared} compared'
    text = f'{counted(report.rotor.valid, "input")}, {judged}'
    if not (worst := worst_field(report)):
        return text
    error, unit = worst.max_error, printable(f' {worst.unit}')
    largest = f'largest error {number(error)}{unit if error else ""}'
    text = f'{text}, {largest} (tolerance {number(worst.tolerance)}{unit if error else ""})'
    wild = sum(field.non_finite for topic in report.topics for field in topic.fields)
    return f'{text}, {counted(wild, "value")} not finite' if wild else text


def worst_field(report: BagReport) -> FieldReport | None:
    """Return the field that used most of its tolerance, if any was compared; a NaN is the most."""
    fields = [field for topic in report.topics for field in topic.fields if field.compared]
    return max(
        fields,
        key=lambda field: math.inf if math.isnan(field.budget_used) else field.budget_used,
        default=None,
    )


def faults(report: BagReport) -> Iterator[Finding]:
    """Yield why topics and their fields fail."""
    for topic in report.topics:
        if not topic.compared:
            yield Finding('no message could be compared', topic=topic.topic, missing=True)
        for count, fault, stamp in (
            (topic.missing, 'missing', topic.first_missing),
            (topic.extra, 'too many', topic.first_extra),
            (topic.out_of_order, 'out of order', topic.first_out_of_order),
        ):
            if count:
                text = f'{counted(count, "message")} {fault}'
                yield Finding(text, topic=topic.topic, stamp=stamp, when=_FIRST, missing=True)
        yield from (replace(fault, topic=topic.topic) for fault in topic.faults)
        for field in topic.fields:
            name = field_name(topic, field)
            if field.is_beyond:
                text = _beyond(field)
                yield Finding(text, topic=name, stamp=field.worst_stamp, when='at')
            for count, fault, stamp in (
                (field.non_finite, 'not finite', field.first_non_finite),
                (field.absent, 'without a counterpart', field.first_absent),
            ):
                if count:
                    text = f'{counted(count, "value")} {fault}'
                    yield Finding(text, topic=name, stamp=stamp, when=_FIRST)


def _beyond(field: FieldReport) -> str:
    quantity = f' of the {QUANTITIES[field.unit]}' if field.unit in QUANTITIES else ''
    angle = field.worst_rotor_angle
    where = '' if angle is None else f' at rotor angle {number(angle, 9)} rad'
    return (
        f'error {number(field.max_error)} {field.unit}{where} exceeds the tolerance{quantity}, '
        f'{number(field.tolerance)} {field.unit}'
    )


def _left_out(report: BagReport) -> Iterator[Finding]:
    """Yield how many messages are not judged, as the recorder lost what they belong to."""
    left_out = sum((Counter(topic.left_out) for topic in report.topics), Counter[str]())
    for cause, count in left_out.items():
        yield Finding(f'{counted(count, "message")} skipped: {_SKIPPED[cause]}')


def field_name(topic: TopicReport, field: FieldReport) -> str:
    """Return the name of a field with its topic."""
    return printable(f'{topic.topic} {field.name}')

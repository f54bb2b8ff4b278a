# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Puts into words everything that is wrong with a recording."""

import math
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

from gear_kinematics.report.document import Sentence, counted, number, printable
from gear_kinematics.validation.causes import LESS_GRAVE, FindingCause
from gear_kinematics.validation.recorder import AFTER, BACK, BEFORE, LOST, NO_INPUT
from gear_kinematics.validation.report import BagReport, FieldReport, Finding, TopicReport
from gear_kinematics.validation.task import QUANTITIES

_LONGEST = 1e8  # s: longer than a recording, so that the stamps are of two clocks
_WHY_LEFT_OUT = {
    BEFORE: 'the recording had just begun',
    AFTER: 'the recording ended first',
    BACK: 'the driver had just come back',
    NO_INPUT: 'the input was not recorded',
    LOST: 'lost by the recorder, by its own count',
}


def findings(report: BagReport) -> list[Sentence]:
    """Return all that is wrong with a bag: its damage, its faults by gravity, and the rest.

    Wrong numbers come before missing messages, and a cause before its effects.
    """
    damage = [] if report.error is None else [Sentence('error', printable(report.error))]
    notes = [found for found in report.findings if not (found.fails or found.explains)]
    gravest = [
        Finding(
            FindingCause.OF_ACTUATOR,
            values={'actuator': each.actuator, 'sentence': findings(each)[0].text},
        )
        for each in report.actuators
        if not each.passed
    ]
    wrong = [*report.causes, *gravest, *faults(report)]
    wrong.sort(key=lambda found: (found.cause in LESS_GRAVE, not found.explains))
    return damage + [
        Sentence(
            'finding',
            printable(f'{found.topic}: ' if found.topic else '') + sentence(found, report),
            None if found.stamp is None else report.seconds(found.stamp),
        )
        for found in (*wrong, *notes, *_left_out(report))
    ]


def explain(report: BagReport) -> str:
    """Return all that is wrong with a bag, a line each."""
    lines = [found.text for found in findings(report)]
    for each in report.actuators:
        lines += [f'{each.actuator}: {found.text}' for found in findings(each)[not each.passed :]]
    return '\n'.join(lines)


def sentence(found: Finding, report: BagReport | None = None) -> str:
    """Put a finding into words, without its topic; the report has the time of the start."""
    text, _, of_moment = found.cause.value.rstrip(']').partition('[')
    moment = ''
    if found.stamp is not None:
        text += of_moment
        time = report.seconds(found.stamp) if report else None
        known = time is not None and abs(time) < _LONGEST
        moment = f'{time:+.3f} s' if known else f'stamp {found.stamp}'
    nouns = {'messages': 'message', 'items': 'value', 'gaps': 'gap'}
    values = {name: counted(found.count, noun) for name, noun in nouns.items()}
    values |= {name: _in_words(value) for name, value in found.values.items()}
    return printable(text.format(moment=moment, **values))


def _in_words(value: Any) -> Any:
    """List names, or counts of messages by topic; leave other values unchanged."""
    if isinstance(value, Mapping):
        value = [f'{counted(count, "message")} of {topic}' for topic, count in value.items()]
    return ', '.join(value) if isinstance(value, list) else value


def answer(report: BagReport) -> str:
    """Return in one line how much was compared, and the largest error with its tolerance."""
    parts = report.actuators or (report,)
    rotors = [each.rotor for each in parts if each.rotor]
    if not rotors:
        return ''
    outputs = sum(topic.compared for topic in report.every_topic)
    wrong = sum(topic.wrong for topic in report.every_topic)
    compared = counted(outputs, 'output')
    judged = f'{wrong} of {compared} wrong' if wrong else f'{compared} compared'
    text = f'{counted(sum(rotor.valid for rotor in rotors), "input")}, {judged}'
    if report.actuators:
        text = f'{counted(len(parts), "actuator")}, {text}'
    if not (worst := worst_field(report)):
        return text
    error, unit = worst.max_error, printable(f' {worst.unit}')
    largest = f'largest error {number(error)}{unit if error else ""}'
    text = f'{text}, {largest} (tolerance {number(worst.tolerance)}{unit if error else ""})'
    wild = sum(field.non_finite for topic in report.every_topic for field in topic.fields)
    return f'{text}, {counted(wild, "value")} not finite' if wild else text


def worst_field(report: BagReport) -> FieldReport | None:
    """Return the field that used most of its tolerance, if any; NaN counts as the greatest use."""
    fields = [field for topic in report.every_topic for field in topic.fields if field.compared]
    return max(
        fields,
        key=lambda field: math.inf if math.isnan(field.budget_used) else field.budget_used,
        default=None,
    )


def faults(report: BagReport) -> Iterator[Finding]:
    """Yield why topics and their fields fail."""
    for topic in report.topics:
        if topic.extra and report.rotor and report.rotor.valid and not topic.compared:
            values = {'topic': report.rotor.topic}
            yield Finding(FindingCause.NO_STAMP_OF_INPUT, topic.topic, values=values)
        elif not topic.compared:
            yield Finding(FindingCause.NOTHING_COMPARED, topic.topic)
        for cause, count, stamp in (
            (FindingCause.MISSING, topic.missing, topic.first_missing),
            (FindingCause.EXTRA, topic.extra, topic.first_extra),
            (FindingCause.OUT_OF_ORDER, topic.out_of_order, topic.first_out_of_order),
        ):
            if count:
                yield Finding(cause, topic.topic, stamp, count)
        yield from (replace(fault, topic=topic.topic) for fault in topic.faults)
        for field in topic.fields:
            name = field_name(topic, field)
            if field.is_beyond:
                stamp = field.worst_stamp
                yield Finding(FindingCause.BEYOND_TOLERANCE, name, stamp, values=_beyond(field))
            for cause, count, stamp in (
                (FindingCause.NOT_FINITE, field.non_finite, field.first_non_finite),
                (FindingCause.ABSENT, field.absent, field.first_absent),
            ):
                if count:
                    yield Finding(cause, name, stamp, count)


def _beyond(field: FieldReport) -> dict[str, str]:
    angle, known = field.worst_rotor_angle, field.unit in QUANTITIES
    return {
        'error': number(field.max_error),
        'tolerance': number(field.tolerance),
        'unit': field.unit,
        'quantity': f' of the {QUANTITIES[field.unit]}' if known else '',
        'where': '' if angle is None else f' at rotor angle {number(angle, 9)} rad',
    }


def _left_out(report: BagReport) -> Iterator[Finding]:
    """Yield how many messages are not judged because the recorder lost their counterparts."""
    left_out = sum((Counter(topic.left_out) for topic in report.topics), Counter[str]())
    for cause, count in left_out.items():
        yield Finding(FindingCause.LEFT_OUT, count=count, values={'why': _WHY_LEFT_OUT[cause]})


def field_name(topic: TopicReport, field: FieldReport) -> str:
    """Return the name of a field with its topic."""
    return printable(f'{topic.topic} {field.name}')

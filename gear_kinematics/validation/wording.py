"""Formulates faults and findings of a validation in sentences."""

import re

from gear_kinematics.report.document import Cell, Finding, counted, number, printable
from gear_kinematics.validation.report import BagReport, FieldReport, TopicReport

_STAMP = re.compile(r'\bstamp (\d{1,19})\b')
"""How every sentence names the moment that it is about."""


def findings(report: BagReport) -> list[Finding]:
    """Return all that is wrong with a bag: its damage, its faults, and their meaning."""
    faults = [
        sentence
        for topic in report.topics
        for sentence in (
            *(f'{printable(topic.topic)}: {fault}' for fault in topic_faults(topic, report)),
            *(
                f'{field_name(topic, field)}: {fault}'
                for field in topic.fields
                for fault in field_faults(field, report)
            ),
        )
    ]
    left_out = [
        printable(f'{topic.topic} {count} {cause}')
        for topic in report.topics
        for cause, count in topic.left_out.items()
    ]
    if left_out:
        left_out = [f'not judged, as caused by the recorder: {", ".join(left_out)}']
    # The cause says more than its effects.
    notes = [finding for finding in report.findings if finding not in report.causes]
    sentences = (*map(printable, report.causes), *faults, *map(printable, notes), *left_out)
    damage = [] if report.error is None else [Finding('error', printable(report.error))]
    return [*damage, *(_finding(sentence, report) for sentence in sentences)]


def _finding(sentence: str, report: BagReport) -> Finding:
    """Return a sentence with the moment that it names."""
    named = _STAMP.search(sentence)
    time = seconds(int(named[1]), report) if named else None
    return Finding('finding', sentence, time)


def topic_faults(topic: TopicReport, report: BagReport) -> list[str]:
    """Return why a topic fails, apart from its fields."""
    faults = []
    if not topic.compared:
        faults.append('no message could be compared')
    if topic.missing:
        first = _first(topic.first_missing, report)
        faults.append(f'{counted(topic.missing, "message")} missing{first}')
    if topic.extra:
        first = _first(topic.first_extra, report)
        faults.append(f'{counted(topic.extra, "message")} too many{first}')
    if topic.out_of_order:
        first = _first(topic.first_out_of_order, report)
        faults.append(f'{counted(topic.out_of_order, "message")} out of order{first}')
    return faults + [printable(fault) for fault in topic.faults]


def field_faults(field: FieldReport, report: BagReport) -> list[str]:
    """Return why a field fails."""
    faults = []
    if is_beyond(field):
        unit = printable(field.unit)
        faults.append(
            f'error {number(field.max_error)} {unit} exceeds the tolerance '
            f'{number(field.tolerance)} {unit}{_worst(field, report)}'
        )
    if field.non_finite:
        first = _first(field.first_non_finite, report)
        faults.append(f'{counted(field.non_finite, "value")} not finite{first}')
    if field.absent:
        samples = counted(field.absent, 'sample')
        first = _first(field.first_absent, report)
        faults.append(f'{samples} with the field in input or output only{first}')
    return faults


def _worst(field: FieldReport, report: BagReport) -> str:
    if field.worst_stamp is None:
        return ''
    rotor_angle = angle(field.worst_rotor_angle)
    rotor = f', rotor angle {rotor_angle} rad' if rotor_angle else ''
    return f' at {_stamp(field.worst_stamp, report)}{rotor}'


def _first(stamp: int | None, report: BagReport) -> str:
    return '' if stamp is None else f', the first at {_stamp(stamp, report)}'


def _stamp(stamp: int, report: BagReport) -> str:
    written, offset = moment(stamp, report)
    return (
        f'stamp {written.text} ({offset.with_unit()})' if offset.text else f'stamp {written.text}'
    )


def seconds(stamp: int, report: BagReport) -> float | None:
    """Return the time of a stamp in ns since the first stamp of the input, s, if there is one."""
    first = report.rotor.first_stamp if report.rotor else None
    return None if first is None else (stamp - first) / 1e9


def moment(stamp: int | None, report: BagReport) -> tuple[Cell, Cell]:
    """Write a stamp in ns, and its distance from the first stamp of the input in s."""
    time = None if stamp is None else seconds(stamp, report)
    offset = '' if time is None else f'{time:+.6f}'
    return Cell('' if stamp is None else str(stamp), unit='ns'), Cell(offset, unit='s')


def angle(value: float | None) -> str:
    """Write a rotor angle; an unknown one is empty."""
    return '' if value is None else number(value, 9)


def is_beyond(field: FieldReport) -> bool:
    """Return whether the error is too great; a NaN is."""
    return not field.max_error <= field.tolerance


def field_name(topic: TopicReport, field: FieldReport) -> str:
    """Return the name of a field with its topic."""
    return printable(f'{topic.topic} {field.name}')

"""All that is wrong with a recording, in sentences."""

from collections.abc import Iterator
from dataclasses import replace

from gear_kinematics.report import document
from gear_kinematics.report.document import Cell, counted, number, printable
from gear_kinematics.validation.report import BagReport, FieldReport, Finding, TopicReport


def findings(report: BagReport) -> list[document.Finding]:
    """Return all that is wrong with a bag: its damage, its faults, and their meaning."""
    damage = [] if report.error is None else [document.Finding('error', printable(report.error))]
    # The cause says more than its effects.
    notes = [finding for finding in report.findings if not (finding.fails or finding.cause)]
    return damage + [
        document.Finding(
            'finding',
            printable(f'{found.topic}: {found.text}' if found.topic else found.text),
            None if found.stamp is None else report.seconds(found.stamp),
        )
        for found in (*report.causes, *faults(report), *notes, *_left_out(report))
    ]


def faults(report: BagReport) -> Iterator[Finding]:
    """Yield why topics and their fields fail."""
    for topic in report.topics:
        yield from _topic_faults(topic, report)
        for field in topic.fields:
            yield from _field_faults(field_name(topic, field), field, report)


def _topic_faults(topic: TopicReport, report: BagReport) -> Iterator[Finding]:
    """Yield why a topic fails, apart from its fields."""
    if not topic.compared:
        yield Finding('no message could be compared', topic=topic.topic)
    for count, fault, stamp in (
        (topic.missing, 'missing', topic.first_missing),
        (topic.extra, 'too many', topic.first_extra),
        (topic.out_of_order, 'out of order', topic.first_out_of_order),
    ):
        if count:
            text = f'{counted(count, "message")} {fault}{_first(stamp, report)}'
            yield Finding(text, topic=topic.topic, stamp=stamp)
    for found in topic.faults:
        yield replace(found, topic=topic.topic)


def _field_faults(name: str, field: FieldReport, report: BagReport) -> Iterator[Finding]:
    """Yield why a field fails."""
    if is_beyond(field):
        text = (
            f'error {number(field.max_error)} {field.unit} exceeds the tolerance '
            f'{number(field.tolerance)} {field.unit}{_worst(field, report)}'
        )
        yield Finding(text, topic=name, stamp=field.worst_stamp)
    if field.non_finite:
        text = f'{counted(field.non_finite, "value")} not finite'
        stamp = field.first_non_finite
        yield Finding(f'{text}{_first(stamp, report)}', topic=name, stamp=stamp)
    if field.absent:
        text = f'{counted(field.absent, "sample")} with the field in input or output only'
        stamp = field.first_absent
        yield Finding(f'{text}{_first(stamp, report)}', topic=name, stamp=stamp)


def _left_out(report: BagReport) -> Iterator[Finding]:
    """Yield what the recorder lost, and is therefore not judged."""
    left_out = [
        f'{topic.topic} {count} {cause}'
        for topic in report.topics
        for cause, count in topic.left_out.items()
    ]
    if left_out:
        yield Finding(f'not judged, as caused by the recorder: {", ".join(left_out)}')


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


def moment(stamp: int | None, report: BagReport) -> tuple[Cell, Cell]:
    """Write a stamp in ns, and its distance from the first stamp of the input in s."""
    time = None if stamp is None else report.seconds(stamp)
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

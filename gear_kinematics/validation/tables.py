# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The tables of a validation."""

from collections.abc import Callable, Iterator, Mapping, Sequence

from gear_kinematics.report.document import OUTCOME, Cell, Layout, Table, Tone, number, printable
from gear_kinematics.validation.findings import angle, field_name, findings, worst_field
from gear_kinematics.validation.report import BagReport, FieldReport, InputReport, TopicReport

Row = tuple[Cell, ...]


def bag_name(report: BagReport) -> str:
    """Return the name of the bag."""
    return printable(report.bag) or '(no name)'


def tables(report: BagReport) -> tuple[Table, ...]:
    """Return all tables about a bag; the first describes the reference of the comparison."""
    fields = [(field_name(t, field), field) for t in report.topics for field in t.fields]
    return (
        Table.of_values(
            Layout.INLINE,
            ('config', printable(report.config)),
            ('gear ratio', printable(report.gear_ratio)),
            ('messages', str(report.messages)),
        ),
        *([_input_table(report.rotor)] if report.rotor else []),
        Table(_GAPS, tuple(_gaps(report))),
        Table.of_items(TOPIC, report.topics),
        Table(_FIELDS, tuple(_field(name, field) for name, field in fields)),
        Table(
            _WORST,
            tuple(
                (
                    Cell(name),
                    *_moment(field.worst_stamp, report),
                    Cell(angle(field.worst_rotor_angle), unit='rad'),
                )
                for name, field in fields
                if field.worst_stamp is not None
            ),
        ),
    )


def summary(reports: Sequence[BagReport]) -> Table:
    """Return a row for each bag: its verdict, how much was compared, and the first finding."""
    columns = 'bag', 'verdict', 'compared', 'largest error', 'tolerance', 'first finding'
    return Table(columns, tuple(map(_summary, reports)), words=('', 'verdict', 'first finding'))


def _summary(report: BagReport) -> Row:
    field = worst_field(report)
    error, tolerance = (field.max_error, field.tolerance) if field else (None, None)
    unit = printable(field.unit) if field else ''
    return (
        Cell(bag_name(report)),
        Cell(OUTCOME[report.verdict], Tone.PLAIN if report.passed else Tone.BAD),
        Cell(str(sum(topic.compared for topic in report.topics))),
        _measured(error, unit),
        _measured(tolerance, unit),
        Cell(next((found.text for found in findings(report)), '')),
    )


def _input_table(rotor: InputReport) -> Table:
    rejected = {f'rejected, {printable(cause)}': n for cause, n in sorted(rotor.rejected.items())}
    counts = {
        'rejected': sum(rotor.rejected.values()),
        **rejected,
        'duplicates': rotor.duplicates,
        'zero stamps': rotor.zero_stamps,
        'unnormalised stamps': rotor.unnormalised_stamps,
        'resets': rotor.resets,
    }
    return Table.of_values(
        Layout.INLINE,
        ('joint', printable(rotor.joint)),
        ('messages', str(rotor.messages)),
        ('valid', str(rotor.valid)),
        *((name, _count(count, Tone.NOTABLE)) for name, count in counts.items()),
        ('rate', _measured(rotor.rate, 'Hz', digits=6)),
        ('duration', _measured(rotor.duration, 's', digits=6)),
        ('gaps', _count(rotor.gaps, Tone.NOTABLE)),
        ('jumps', _count(rotor.jumps, Tone.NOTABLE)),
        ('overspeed', _count(rotor.overspeed, Tone.NOTABLE)),
        ('max speed', _measured(rotor.max_speed, 'rad/s', digits=6)),
        ('referenced', Cell('yes') if rotor.referenced else Cell('no', Tone.NOTABLE)),
        about=('input', printable(rotor.topic)),
    )


_GAPS = 'longest gaps', 'until stamp', 'from start', 'silence', 'rotor turned'


def _gaps(report: BagReport) -> Iterator[Row]:
    if rotor := report.rotor:
        for k, gap in enumerate(rotor.longest_gaps, 1):
            yield (
                Cell(printable(f'{rotor.topic} gap {k}')),
                *_moment(gap.stamp, report),
                _measured(gap.seconds, 's', digits=6),
                _measured(gap.turned, 'rad', digits=6),
            )


TOPIC: Mapping[str, Callable[[TopicReport], str | Cell]] = {
    'topic': lambda topic: printable(topic.topic),
    'messages': lambda topic: str(topic.messages),
    'compared': lambda topic: Cell(str(topic.compared), *[Tone.BAD] * (not topic.compared)),
    'missing': lambda topic: _count(topic.missing),
    'extra': lambda topic: _count(topic.extra),
    'duplicates': lambda topic: _count(topic.duplicates, Tone.NOTABLE),
    'out of order': lambda topic: _count(topic.out_of_order),
    'left out': lambda topic: Cell(str(sum(topic.left_out.values()) or ''), Tone.NOTABLE),
}
"""The columns about a topic."""
_FIELDS = 'field', 'compared', 'absent', 'not finite', 'max error', 'tolerance', 'rms error'
_WORST = 'field', 'worst at stamp', 'worst from start', 'worst at rotor angle'


def _field(name: str, field: FieldReport) -> Row:
    unit = printable(field.unit)
    errors = (field.max_error, field.tolerance, field.rms_error) if field.compared else [None] * 3
    greatest, *others = (_measured(error, unit) for error in errors)
    return (
        Cell(name, unit=unit),
        Cell(str(field.compared)),
        _count(field.absent),
        _count(field.non_finite),
        Cell(greatest.text, Tone.BAD if field.is_beyond else Tone.PLAIN, unit),
        *others,
    )


def _measured(value: float | None, unit: str, digits: int = 3) -> Cell:
    return Cell('' if value is None else number(value, digits), unit=unit)


def _count(count: int, tone: Tone = Tone.BAD) -> Cell:
    return Cell(str(count), tone if count else Tone.NONE)


def _moment(stamp: int | None, report: BagReport) -> Row:
    """Write a stamp in ns, and its distance from the first stamp of the input in s."""
    time = None if stamp is None else report.seconds(stamp)
    offset = '' if time is None else f'{time:+.6f}'
    return Cell('' if stamp is None else str(stamp), unit='ns'), Cell(offset, unit='s')

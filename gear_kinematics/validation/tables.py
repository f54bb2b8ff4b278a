"""The tables of a validation, each defined by its headings and the contents of the columns."""

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from gear_kinematics.report.document import OUTCOME, Cell, Layout, Table, Tone, number, printable
from gear_kinematics.validation.findings import (
    angle,
    field_name,
    findings,
    moment,
    worst_field,
)
from gear_kinematics.validation.report import BagReport, FieldReport, Gap, InputReport, TopicReport


def bag_name(report: BagReport) -> str:
    """Return the name of the bag."""
    return printable(report.bag) or '(no name)'


def tables(report: BagReport) -> tuple[Table, ...]:
    """Return all tables about a bag; the first describes the reference of the comparison."""
    gaps = report.rotor.longest_gaps if report.rotor else ()
    fields = [_Field(report, topic, field) for topic in report.topics for field in topic.fields]
    worst = [row for row in fields if row.field.worst_stamp is not None]
    return (
        Table.of_values(
            Layout.INLINE,
            ('config', printable(report.config)),
            ('gear ratio', printable(report.gear_ratio)),
            ('messages', str(report.messages)),
        ),
        *([_input_table(report.rotor)] if report.rotor else []),
        Table.of_items(_GAP, [_Gap(report, k, gap) for k, gap in enumerate(gaps, 1)]),
        Table.of_items(TOPIC, report.topics),
        Table.of_items(_FIELD, fields),
        Table.of_items(_WORST, worst),
    )


def summary(reports: Sequence[BagReport]) -> Table:
    """Return a row for each bag: its verdict, how much was compared, and the first finding."""
    return Table.of_items(_SUMMARY, reports, words=('', 'verdict', 'first finding'))


class _Gap(NamedTuple):
    report: BagReport
    number: int
    gap: Gap

    @property
    def name(self) -> str:
        topic = self.report.rotor.topic if self.report.rotor else ''
        return printable(f'{topic} gap {self.number}')


class _Field(NamedTuple):
    report: BagReport
    topic: TopicReport
    field: FieldReport

    @property
    def name(self) -> str:
        return field_name(self.topic, self.field)

    @property
    def tone(self) -> Tone:
        return _tone(bad=self.field.is_beyond)

    def measured(self, value: float, tone: Tone = Tone.PLAIN) -> Cell:
        text = number(value) if self.field.compared else ''
        return Cell(text, tone, printable(self.field.unit))


def _input_table(rotor: InputReport) -> Table:
    rejected = [(f'rejected, {printable(c)}', _notable(n)) for c, n in rotor.rejected.items()]
    return Table.of_values(
        Layout.INLINE,
        ('joint', printable(rotor.joint)),
        ('messages', str(rotor.messages)),
        ('valid', str(rotor.valid)),
        ('rejected', _notable(sum(rotor.rejected.values()))),
        *sorted(rejected, key=lambda column: column[0]),
        ('duplicates', _notable(rotor.duplicates)),
        ('zero stamps', _notable(rotor.zero_stamps)),
        ('unnormalised stamps', _notable(rotor.unnormalised_stamps)),
        ('resets', _notable(rotor.resets)),
        ('rate', Cell(number(rotor.rate, 6), unit='Hz')),
        ('duration', Cell(number(rotor.duration, 6), unit='s')),
        ('gaps', _notable(rotor.gaps)),
        ('jumps', _notable(rotor.jumps)),
        ('overspeed', _notable(rotor.overspeed)),
        ('max speed', Cell(number(rotor.max_speed, 6), unit='rad/s')),
        ('referenced', Cell('yes') if rotor.referenced else Cell('no', Tone.NOTABLE)),
        about=('input', printable(rotor.topic)),
    )


def _of_worst(report: BagReport, attribute: str) -> Cell:
    field = worst_field(report)
    if not field:
        return Cell('')
    return Cell(number(getattr(field, attribute)), unit=printable(field.unit))


def _bad(count: int) -> Cell:
    return Cell(str(count), Tone.BAD if count else Tone.NONE)


def _notable(count: int) -> Cell:
    return Cell(str(count), Tone.NOTABLE if count else Tone.NONE)


def _tone(*, bad: bool) -> Tone:
    return Tone.BAD if bad else Tone.PLAIN


_GAP: Mapping[str, Callable[[_Gap], str | Cell]] = {
    'longest gaps': lambda row: row.name,
    'until stamp': lambda row: moment(row.gap.stamp, row.report)[0],
    'from start': lambda row: moment(row.gap.stamp, row.report)[1],
    'silence': lambda row: Cell(number(row.gap.seconds, 6), unit='s'),
    'rotor turned': lambda row: Cell(number(row.gap.turned, 6), unit='rad'),
}
TOPIC: Mapping[str, Callable[[TopicReport], str | Cell]] = {
    'topic': lambda topic: printable(topic.topic),
    'messages': lambda topic: str(topic.messages),
    'compared': lambda topic: Cell(str(topic.compared), _tone(bad=not topic.compared)),
    'missing': lambda topic: _bad(topic.missing),
    'extra': lambda topic: _bad(topic.extra),
    'duplicates': lambda topic: _notable(topic.duplicates),
    'out of order': lambda topic: _bad(topic.out_of_order),
    'left out': lambda topic: Cell(str(sum(topic.left_out.values()) or ''), Tone.NOTABLE),
}
_FIELD: Mapping[str, Callable[[_Field], str | Cell]] = {
    'field': lambda row: Cell(row.name, unit=printable(row.field.unit)),
    'compared': lambda row: str(row.field.compared),
    'absent': lambda row: _bad(row.field.absent),
    'not finite': lambda row: _bad(row.field.non_finite),
    'max error': lambda row: row.measured(row.field.max_error, row.tone),
    'tolerance': lambda row: row.measured(row.field.tolerance),
    'rms error': lambda row: row.measured(row.field.rms_error),
}
_WORST: Mapping[str, Callable[[_Field], str | Cell]] = {
    'field': lambda row: row.name,
    'worst at stamp': lambda row: moment(row.field.worst_stamp, row.report)[0],
    'worst from start': lambda row: moment(row.field.worst_stamp, row.report)[1],
    'worst at rotor angle': lambda row: Cell(angle(row.field.worst_rotor_angle), unit='rad'),
}
_SUMMARY: Mapping[str, Callable[[BagReport], str | Cell]] = {
    'bag': bag_name,
    'verdict': lambda report: Cell(OUTCOME[report.verdict], _tone(bad=not report.passed)),
    'compared': lambda report: str(sum(topic.compared for topic in report.topics)),
    'largest error': lambda report: _of_worst(report, 'max_error'),
    'tolerance': lambda report: _of_worst(report, 'tolerance'),
    'first finding': lambda report: next((found.text for found in findings(report)), ''),
}

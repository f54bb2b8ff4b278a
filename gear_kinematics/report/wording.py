"""What every rendering says, and in which order: tables, sentences, numbers and names.

Text is safe to print on a terminal, yet not escaped for markup, HTML or XML.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum

from gear_kinematics.validation.report import (
    BagReport,
    FieldReport,
    InputReport,
    TopicReport,
    Verdict,
)

OUTCOME = {Verdict.PASS: 'passed', Verdict.FAIL: 'failed', Verdict.UNUSABLE: 'unusable'}


class Tone(StrEnum):
    """What a number means for the verdict."""

    PLAIN = ''
    NOTABLE = 'notable'
    BAD = 'bad'


@dataclass(frozen=True, slots=True)
class Cell:
    """A value of a table, ready to be read."""

    text: str
    tone: Tone = Tone.PLAIN
    unit: str = ''
    """Of the value; of all values of a row where it stands with the first cell."""

    def with_unit(self) -> str:
        """Give the value with its unit."""
        return f'{self.text} {self.unit}' if self.text and self.unit else self.text

    def as_subject(self) -> str:
        """Head a row with the name, and the unit of all its values."""
        return f'{self.text} [{self.unit}]' if self.unit else self.text

    def in_row_of(self, subject: 'Cell') -> str:
        """Give the value, with its unit unless the head of the row tells it."""
        return self.text if self.unit == subject.unit else self.with_unit()


@dataclass(frozen=True, slots=True)
class Table:
    """Rows of values; the first of a row says what it is about."""

    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    prose: tuple[str, ...] = ()
    """Columns of words; the first is one in any case, and the others hold numbers."""

    def facts(self) -> Iterator[tuple[str, str, Cell]]:
        """Give every value that is there, with what it is about and its column."""
        for subject, *cells in self.rows:
            for column, cell in zip(self.columns[1:], cells, strict=True):
                if cell.text:
                    yield subject.text, column, cell

    def without_empty_columns(self) -> 'Table':
        """Leave out the columns in which no row says anything."""
        kept = [k for k in range(len(self.columns)) if any(row[k].text for row in self.rows)]
        rows = tuple(tuple(row[k] for k in kept) for row in self.rows)
        return Table(tuple(self.columns[k] for k in kept), rows, self.prose)


def printable(text: str) -> str:
    """Spell out what no terminal, log or XML file should get: control characters and the like.

    Names come from bags and file systems: they may hold line ends, escape sequences, marks that
    turn the direction of writing, and bytes that are no text.
    """
    return ''.join(
        char if char.isprintable() else char.encode('unicode_escape').decode() for char in text
    )


def number(value: float, digits: int = 3) -> str:
    """Write a measured value, with an exponent as short as it can be."""
    mantissa, e, exponent = f'{value:.{digits}g}'.partition('e')
    return f'{mantissa}{e}{int(exponent)}' if e else mantissa


def bag_name(report: BagReport) -> str:
    """Name the bag."""
    return printable(report.bag) or '(no name)'


def tally(reports: Sequence[BagReport]) -> dict[Verdict, int]:
    """Count the bags of each verdict, from best to worst."""
    return {verdict: sum(report.verdict == verdict for report in reports) for verdict in Verdict}


def worst_verdict(reports: Sequence[BagReport]) -> Verdict:
    """Give the verdict on all bags together; none at all are unusable."""
    order = list(Verdict)
    return max((r.verdict for r in reports), key=order.index, default=Verdict.UNUSABLE)


def totals(reports: Sequence[BagReport]) -> str:
    """Say how many bags there are of each verdict."""
    counts = ', '.join(f'{count} {OUTCOME[verdict]}' for verdict, count in tally(reports).items())
    return f'{_count(len(reports), "bag")}: {counts}'


def first_stamp(report: BagReport) -> int | None:
    """Give the stamp from which offsets count, if it is known."""
    return report.rotor.first_stamp if report.rotor else None


def field_name(topic: TopicReport, field: FieldReport) -> str:
    """Name a field of a topic."""
    return printable(f'{topic.topic} {field.name}')


# Tables


def head(report: BagReport) -> Table:
    """Say what the report is about."""
    return Table(
        ('', 'config', 'gear ratio', 'messages'),
        (
            (
                Cell(''),
                Cell(printable(report.config)),
                Cell(printable(report.gear_ratio)),
                Cell(str(report.messages)),
            ),
        ),
    )


def rotor_table(rotor: InputReport) -> Table:
    """Tell the health of the input."""
    rejected = {printable(cause): count for cause, count in sorted(rotor.rejected.items())}
    return Table(
        (
            'input',
            'joint',
            'messages',
            'valid',
            'rejected',
            *(f'rejected, {cause}' for cause in rejected),
            'duplicates',
            'zero stamps',
            'unnormalised stamps',
            'resets',
            'rate',
            'duration',
            'gaps',
            'jumps',
            'overspeed',
            'max speed',
            'referenced',
        ),
        (
            (
                Cell(printable(rotor.topic)),
                Cell(printable(rotor.joint)),
                Cell(str(rotor.messages)),
                Cell(str(rotor.valid)),
                _notable(sum(rejected.values())),
                *map(_notable, rejected.values()),
                _notable(rotor.duplicates),
                _notable(rotor.zero_stamps),
                _notable(rotor.unnormalised_stamps),
                _notable(rotor.resets),
                Cell(number(rotor.rate, 6), unit='Hz'),
                Cell(number(rotor.duration, 6), unit='s'),
                _notable(rotor.gaps),
                _notable(rotor.jumps),
                _notable(rotor.overspeed),
                Cell(number(rotor.max_speed, 6), unit='rad/s'),
                Cell('yes') if rotor.referenced else Cell('no', Tone.NOTABLE),
            ),
        ),
    )


def gap_table(report: BagReport) -> Table:
    """List the longest gaps of the input, each with the stamp that ends it."""
    rotor = report.rotor
    return Table(
        ('longest gaps', 'until stamp', 'from start', 'silence', 'rotor turned'),
        tuple(
            (
                Cell(printable(f'{rotor.topic} gap {k}')),
                *_moment(gap.stamp, report),
                Cell(number(gap.seconds, 6), unit='s'),
                Cell(number(gap.turned, 6), unit='rad'),
            )
            for k, gap in enumerate(rotor.longest_gaps, 1)
        )
        if rotor
        else (),
    )


def topic_table(report: BagReport) -> Table:
    """Tell of each topic what was there and what was not."""
    return Table(
        (
            'topic',
            'messages',
            'compared',
            'missing',
            'extra',
            'duplicates',
            'out of order',
            'left out',
        ),
        tuple(
            (
                Cell(printable(topic.topic)),
                Cell(str(topic.messages)),
                Cell(str(topic.compared), _tone(bad=not topic.compared)),
                _bad(topic.missing),
                _bad(topic.extra),
                _notable(topic.duplicates),
                _bad(topic.out_of_order),
                Cell(str(sum(topic.left_out.values()) or ''), Tone.NOTABLE),
            )
            for topic in report.topics
        ),
    )


def field_table(report: BagReport) -> Table:
    """Tell of each field how far it is off."""
    return Table(
        (
            'field',
            'compared',
            'absent',
            'not finite',
            'max error',
            'rms error',
            'tolerance',
            'budget used',
        ),
        tuple(_field_row(topic, field) for topic, field in _fields(report)),
    )


def _field_row(topic: TopicReport, field: FieldReport) -> tuple[Cell, ...]:
    beyond = _tone(bad=_is_beyond(field))

    def measured(value: float, tone: Tone = Tone.PLAIN) -> Cell:
        return Cell(number(value) if field.compared else '', tone, printable(field.unit))

    return (
        Cell(field_name(topic, field), unit=printable(field.unit)),
        Cell(str(field.compared)),
        _bad(field.absent),
        _bad(field.non_finite),
        measured(field.max_error, beyond),
        measured(field.rms_error),
        measured(field.tolerance),
        Cell(_budget([field]), beyond, unit='%'),
    )


def worst_table(report: BagReport) -> Table:
    """Tell where the greatest error of each field is."""
    return Table(
        ('field', 'worst at stamp', 'worst from start', 'worst at rotor angle'),
        tuple(
            (
                Cell(field_name(topic, field)),
                *_moment(field.worst_stamp, report),
                Cell(_angle(field.worst_rotor_angle), unit='rad'),
            )
            for topic, field in _fields(report)
            if field.worst_stamp is not None
        ),
    )


def summary_table(reports: Sequence[BagReport]) -> Table:
    """Give a line for each bag: the verdict, how much was compared, and what is the matter."""
    return Table(
        ('bag', 'verdict', 'compared', 'budget used', 'first finding'),
        tuple(
            (
                Cell(bag_name(report)),
                Cell(OUTCOME[report.verdict], _tone(bad=not report.passed)),
                Cell(str(sum(topic.compared for topic in report.topics))),
                Cell(_budget([field for _, field in _fields(report)]), unit='%'),
                Cell(next(iter(remarks(report)), '')),
            )
            for report in reports
        ),
        prose=('verdict', 'first finding'),
    )


# Sentences


def remarks(report: BagReport) -> list[str]:
    """Say all that is the matter with a bag: its damage, its faults, and what they mean."""
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
    findings = [printable(finding) for finding in report.findings]
    return error(report) + faults + findings + _left_out(report)


def error(report: BagReport) -> list[str]:
    """Say what made the bag unusable, if anything did."""
    return [] if report.error is None else [printable(report.error)]


def _left_out(report: BagReport) -> list[str]:
    """Say in one sentence what was not judged, and why, if anything was not."""
    parts = [
        printable(f'{topic.topic} {count} {cause}')
        for topic in report.topics
        for cause, count in topic.left_out.items()
    ]
    return [f"not judged, as the recorder's doing: {', '.join(parts)}"] if parts else []


def topic_faults(topic: TopicReport, report: BagReport) -> list[str]:
    """Say why a topic fails, whatever its fields say."""
    faults = []
    if not topic.compared:
        faults.append('no message could be compared')
    if topic.missing:
        first = _first(topic.first_missing, report)
        faults.append(f'{_count(topic.missing, "message")} missing{first}')
    if topic.extra:
        first = _first(topic.first_extra, report)
        faults.append(f'{_count(topic.extra, "message")} too many{first}')
    if topic.out_of_order:
        first = _first(topic.first_out_of_order, report)
        faults.append(f'{_count(topic.out_of_order, "message")} out of order{first}')
    return faults + [printable(fault) for fault in topic.faults]


def field_faults(field: FieldReport, report: BagReport) -> list[str]:
    """Say why a field fails."""
    faults = []
    if _is_beyond(field):
        unit = printable(field.unit)
        faults.append(
            f'error {number(field.max_error)} {unit} exceeds the tolerance '
            f'{number(field.tolerance)} {unit}{_worst(field, report)}'
        )
    if field.non_finite:
        first = _first(field.first_non_finite, report)
        faults.append(f'{_count(field.non_finite, "value")} not finite{first}')
    if field.absent:
        samples = _count(field.absent, 'sample')
        first = _first(field.first_absent, report)
        faults.append(f'{samples} with the field in input or output only{first}')
    return faults


def _worst(field: FieldReport, report: BagReport) -> str:
    if field.worst_stamp is None:
        return ''
    angle = _angle(field.worst_rotor_angle)
    rotor = f', rotor angle {angle} rad' if angle else ''
    return f' at {_stamp(field.worst_stamp, report)}{rotor}'


def _first(stamp: int | None, report: BagReport) -> str:
    return '' if stamp is None else f', the first at {_stamp(stamp, report)}'


def _stamp(stamp: int, report: BagReport) -> str:
    written, offset = _moment(stamp, report)
    return (
        f'stamp {written.text} ({offset.with_unit()})' if offset.text else f'stamp {written.text}'
    )


def _moment(stamp: int | None, report: BagReport) -> tuple[Cell, Cell]:
    """Write a stamp in ns, and its distance from the first one."""
    first = first_stamp(report)
    offset = '' if stamp is None or first is None else f'{(stamp - first) / 1e9:+.6f}'
    return Cell('' if stamp is None else str(stamp), unit='ns'), Cell(offset, unit='s')


def _angle(angle: float | None) -> str:
    return '' if angle is None else number(angle, 9)


def _budget(fields: Sequence[FieldReport]) -> str:
    """Give the greatest budget that any field used, in percent."""
    used = [100 * field.budget_used for field in fields if field.compared]
    # A NaN is the worst of all, and no maximum of the others.
    return number(math.nan if any(map(math.isnan, used)) else max(used)) if used else ''


def _fields(report: BagReport) -> Iterator[tuple[TopicReport, FieldReport]]:
    return ((topic, field) for topic in report.topics for field in topic.fields)


def _is_beyond(field: FieldReport) -> bool:
    """Whether the error is too great; a NaN is."""
    return not field.max_error <= field.tolerance


def _count(count: int, noun: str) -> str:
    return f'{count} {noun}' if count == 1 else f'{count} {noun}s'


def _bad(count: int) -> Cell:
    return Cell(str(count), _tone(bad=count > 0))


def _notable(count: int) -> Cell:
    return Cell(str(count), Tone.NOTABLE if count else Tone.PLAIN)


def _tone(*, bad: bool) -> Tone:
    return Tone.BAD if bad else Tone.PLAIN

"""The report on a terminal, and as plain lines in a pipe."""

from collections.abc import Iterable, Iterator, Sequence

from rich import box
from rich.columns import Columns
from rich.console import Console
from rich.table import Table as RichTable
from rich.text import Text

from gear_kinematics.report import wording
from gear_kinematics.report.wording import OUTCOME, Table, Tone
from gear_kinematics.validation.report import BagReport, Verdict

_NARROWEST = 80
"""Columns that a table takes without its numbers being cut."""
_VERDICT_STYLES = {
    Verdict.PASS: 'bold green',
    Verdict.FAIL: 'bold red',
    Verdict.UNUSABLE: 'bold magenta',
}
_TONE_STYLES = {Tone.PLAIN: '', Tone.NOTABLE: 'yellow', Tone.BAD: 'bold red'}


def render(reports: Sequence[BagReport], console: Console) -> None:
    """Print the reports: tables on a terminal that has room, one fact per line elsewhere."""
    if is_wide(console):
        _render_tables(reports, console)
    else:
        print_lines(lines(reports), console)


def is_wide(console: Console) -> bool:
    """Whether this is a terminal on which tables have room."""
    return console.is_terminal and console.width >= _NARROWEST


def print_lines(lines: Iterable[str], console: Console) -> None:
    """Print lines as they are, however long."""
    for line in lines:
        # A name must not stop the report where the pipe's encoding cannot express it.
        written = line.encode(console.encoding, 'backslashreplace').decode(console.encoding)
        console.print(Text(written), soft_wrap=True)


def lines(reports: Sequence[BagReport]) -> Iterator[str]:
    """Give one fact per line, each with the bag it is about."""
    for report in reports:
        yield from bag_lines(report)
    if len(reports) > 1:
        yield f'summary: {wording.totals(reports)}'


def bag_lines(report: BagReport) -> Iterator[str]:
    """Give the facts about one bag, a line each."""
    bag = wording.bag_name(report)
    yield f'{bag}: verdict: {OUTCOME[report.verdict]}'
    damage = wording.error(report)
    for kind, sentences in ('error', damage), ('finding', wording.remarks(report)[len(damage) :]):
        for sentence in sentences:
            yield f'{bag}: {kind}: {sentence}'
    for table in (wording.head(report), *_tables(report, with_rotor=True)):
        for subject, column, cell in table.facts():
            about = f'{subject}: {column}' if subject else column
            yield f'{bag}: {about}: {cell.with_unit()}'


def _tables(report: BagReport, *, with_rotor: bool) -> Iterator[Table]:
    if with_rotor and report.rotor:
        yield wording.rotor_table(report.rotor)
    yield wording.gap_table(report)
    yield wording.topic_table(report)
    yield wording.field_table(report)
    yield wording.worst_table(report)


def _render_tables(reports: Sequence[BagReport], console: Console) -> None:
    for report in reports:
        _render_bag(report, console)
    if len(reports) > 1:
        console.print(Text(wording.totals(reports), 'bold'))
        console.print()
        console.print(rich_table(wording.summary_table(reports)))


def _render_bag(report: BagReport, console: Console) -> None:
    style = _VERDICT_STYLES[report.verdict]
    verdict = (f'{OUTCOME[report.verdict].upper()} ', style)
    name = (wording.bag_name(report), 'bold')
    console.print(Text.assemble(verdict, name, overflow='fold'))
    console.print(in_columns(wording.head(report)))
    if report.rotor:
        console.print(in_columns(wording.rotor_table(report.rotor)))
    for table in _tables(report, with_rotor=False):
        if table.rows:
            console.print()
            console.print(rich_table(table))
    remarks = wording.remarks(report)
    if remarks:
        console.print()
    for remark in remarks:
        console.print(item(remark, '' if report.passed else style))
    console.print()


def item(sentence: str, style: str) -> RichTable:
    """Set a sentence beside its bullet, so that it wraps below itself."""
    item = RichTable.grid(padding=(0, 1))
    item.add_row(Text('•', style), Text(sentence, overflow='fold'))
    return item


def in_columns(table: Table) -> Columns:
    """Set the only row of a table of many columns as labelled values."""
    values = []
    if subject := table.rows[0][0].text:
        values.append(Text.assemble((f'{table.columns[0]} ', 'dim'), (subject, 'bold')))
    for _, column, cell in table.facts():
        value = (cell.with_unit(), _TONE_STYLES[cell.tone])
        values.append(Text.assemble((f'{column} ', 'dim'), value))
    return Columns(values, padding=(0, 3))


def rich_table(table: Table) -> RichTable:
    """Set a table; numbers are never broken, words and headings are."""
    table = table.without_empty_columns()
    rich_table = RichTable(
        box=box.SIMPLE_HEAD, show_edge=False, padding=(0, 1, 0, 0), header_style='dim'
    )
    for k, column in enumerate(table.columns):
        if k == 0 or column in table.prose:
            rich_table.add_column(Text(column), overflow='fold')
        else:
            # Numbers are never broken; headings are, so that columns are narrow.
            heading = Text('\n'.join(column.rsplit(' ', 1)))
            rich_table.add_column(heading, justify='right', no_wrap=True, vertical='top')
    for subject, *cells in table.rows:
        values = (Text(cell.in_row_of(subject), _TONE_STYLES[cell.tone]) for cell in cells)
        rich_table.add_row(Text(subject.as_subject()), *values)
    return rich_table

"""Prints a report as tables on a terminal, or as plain lines in a pipe."""

from collections.abc import Iterator

from rich import box
from rich.columns import Columns
from rich.console import Console, RenderableType
from rich.table import Table as RichTable
from rich.text import Text

from gear_kinematics.report.document import (
    OUTCOME,
    Cell,
    Document,
    Layout,
    Section,
    Table,
    Tone,
    Verdict,
)

_NARROWEST = 80
"""Least width of a terminal for tables, columns."""
_VERDICT_STYLES = {
    None: '',
    Verdict.PASS: 'bold green',
    Verdict.FAIL: 'bold red',
    Verdict.UNUSABLE: 'bold magenta',
}
_TONE_STYLES = {Tone.PLAIN: '', Tone.CHOSEN: 'bold', Tone.NOTABLE: 'yellow', Tone.BAD: 'bold red'}


def render(document: Document, console: Console, *, brief: bool = False) -> None:
    """Print a report: tables on a terminal that is wide enough, one fact per line elsewhere.

    Args:
        document: the report.
        console: to print it on.
        brief: whether elsewhere a section that passed is a single line, and one without a verdict
            its findings.
    """
    if not (console.is_terminal and console.width >= _NARROWEST):
        for line in lines(document, brief=brief):
            # The pipe's encoding may lack characters of a name.
            written = line.encode(console.encoding, 'backslashreplace').decode(console.encoding)
            console.print(Text(written), soft_wrap=True)
        return
    for section in document.sections:
        _render_section(section, console)
    if len(document.sections) > 1:
        if document.totals:
            console.print(Text(document.totals, 'bold'))
            console.print()
        if document.summary:
            console.print(_rows(document.summary))


def lines(document: Document, *, brief: bool = False) -> Iterator[str]:
    """Yield one fact per line, each with the section it belongs to; see `render`."""
    summary = [f'summary: {document.totals}'] if document.totals and document.sections[1:] else []
    compared = any(section.leads for section in document.sections)
    yield from summary if compared else ()
    for section in document.sections:
        if brief and section.verdict is None:
            yield from (f'{section.name}: {finding.text}' for finding in section.findings)
        elif brief and section.verdict == Verdict.PASS:
            findings = ''.join(f'; {finding.text}' for finding in section.findings)
            yield f'{section.name}: verdict: {OUTCOME[section.verdict]}{findings}'
        else:
            yield from section_lines(section)
    yield from () if compared else summary


def section_lines(section: Section) -> Iterator[str]:
    """Yield the facts of one section, a line each."""
    name = f'{section.name}: ' if section.name else ''
    if section.verdict:
        yield f'{name}verdict: {OUTCOME[section.verdict]}'
    for finding in section.findings:
        yield f'{name}{finding.kind}: {finding.text}'
    for table in section.tables:
        for subject, column, cell in table.facts():
            about = ': '.join(filter(None, [subject, column]))
            yield f'{name}{about}: {cell.with_unit()}'
    for remark in section.remarks:
        yield f'{name}remark: {remark}'


def _render_section(section: Section, console: Console) -> None:
    style = _VERDICT_STYLES[section.verdict]
    if section.name:
        verdict = (f'{OUTCOME[section.verdict].upper()} ', style) if section.verdict else ''
        console.print(Text.assemble(verdict, (section.name, 'bold'), overflow='fold'))
    for finding in section.findings:
        console.print(_bullet(finding.text, '' if section.verdict == Verdict.PASS else style))
    for table in filter(lambda table: table.rows, section.tables):
        if table.layout == Layout.ROWS:
            console.print()
        console.print(_LAYOUTS[table.layout](table))
    if section.remarks:
        console.print()
    for remark in section.remarks:
        console.print(_bullet(remark))
    console.print()


def _bullet(sentence: str, style: str = '') -> RichTable:
    """Return a sentence with a bullet and a hanging indent."""
    item = RichTable.grid(padding=(0, 1))
    item.add_row(Text('•', style), Text(sentence, overflow='fold'))
    return item


def _inline(table: Table) -> RenderableType:
    values = []
    if subject := table.rows[0][0].text:
        values.append(Text.assemble((f'{table.columns[0]} ', 'dim'), (subject, 'bold')))
    for _, column, cell in table.facts():
        values.append(Text.assemble((f'{column} ', 'dim'), _styled(cell, cell.with_unit())))
    return Columns(values, padding=(0, 3))


def _lines(table: Table) -> RenderableType:
    grid = RichTable.grid(padding=(0, 2))
    for _, column, cell in table.facts():
        grid.add_row(Text(column, 'dim'), _styled(cell, cell.with_unit()))
    return grid


def _rows(table: Table) -> RenderableType:
    """Return rows below headings; words and headings may wrap, numbers do not."""
    table = table.below_headings()
    rich_table = RichTable(
        box=box.SIMPLE_HEAD, show_edge=False, padding=(0, 1, 0, 0), header_style='dim'
    )
    for k, column in enumerate(table.columns):
        if table.is_words(k):
            rich_table.add_column(Text(column), overflow='fold')
        else:
            heading = Text('\n'.join(column.rsplit(' ', 1)))
            rich_table.add_column(heading, justify='right', no_wrap=True, vertical='top')
    for row in table.rows:
        rich_table.add_row(*(_styled(cell, cell.text) for cell in row))
    return rich_table


def _styled(cell: Cell, text: str) -> Text:
    return Text(text, _TONE_STYLES[cell.tone])


_LAYOUTS = {Layout.ROWS: _rows, Layout.INLINE: _inline, Layout.LINES: _lines}

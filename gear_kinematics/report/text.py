# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Prints a report as tables on a terminal, or as plain lines in a pipe."""

from collections.abc import Iterator
from dataclasses import replace

from rich import box
from rich.console import Console, Group, RenderableType
from rich.table import Table
from rich.text import Text

from gear_kinematics.report import document as doc
from gear_kinematics.report.document import OUTCOME, Tone, Verdict

_PADDING = 2  # number of blank characters between two columns of a table
_VERDICT_STYLES = {
    None: '',
    Verdict.PASS: 'bold green',
    Verdict.FAIL: 'bold red',
    Verdict.UNUSABLE: 'bold magenta',
}
_TONE_STYLES = {Tone.PLAIN: '', Tone.NONE: 'dim', Tone.NOTABLE: 'yellow', Tone.BAD: 'bold red'}


def render(document: doc.Document, console: Console, *, brief: bool = False) -> None:
    """Print a report: tables on a terminal, one row per line elsewhere.

    A brief report has of each section its verdict, findings and answer; in a pipe, a section that
    passed is a single line. On a terminal, only sections with an answer, or unusable, are brief.
    """
    if not console.is_terminal:
        for line in lines(document, brief=brief):
            console.print(Text(line), soft_wrap=True)
        return
    document = document.in_order()
    several = len(document.sections) > 1
    if several and document.totals:
        console.print(Text(document.totals, 'bold'))
        console.print()
    for section in document.sections:
        shortened = brief and bool(section.answer or section.verdict == Verdict.UNUSABLE)
        if not (several and shortened and section.verdict == Verdict.PASS):
            _render_section(section, console, brief=shortened)
    if several and document.summary:
        console.print(_rows(document.summary, console))
        console.print()
    if several and document.totals:
        console.print(Text(document.totals, 'bold'))


def lines(document: doc.Document, *, brief: bool = False) -> Iterator[str]:
    """Yield a row of a table per line, each with the section it belongs to; see `render`."""
    if document.totals:
        yield f'summary: {document.totals}'
    for section in document.in_order().sections:
        name = f'{section.name}: ' if section.name else ''
        findings = [finding.text for finding in section.findings]
        if brief and section.verdict is None:
            yield from (f'{name}{text}' for text in findings)
        elif brief and section.verdict == Verdict.PASS:
            verdict = OUTCOME[section.verdict]
            for text in filter(None, [section.answer, *findings]):
                verdict = _joined(verdict, text)
            yield f'{name}verdict: {verdict}'
        else:
            yield from section_lines(section, brief=brief)


def section_lines(section: doc.Section, *, brief: bool = False) -> Iterator[str]:
    """Yield one section line by line; a brief one is without values."""
    name = f'{section.name}: ' if section.name else ''
    findings, answer = list(section.findings), section.answer
    if section.verdict:
        verdict = f'{name}verdict: {OUTCOME[section.verdict]}'
        if section.verdict != Verdict.PASS and findings:
            gravest = findings.pop(0).text.removesuffix('.')
            if name:  # an error begins with it, on a cluster as an absolute path
                gravest = gravest.rpartition(name)[2]
            verdict += f': {gravest}'
        yield _joined(verdict, answer) if answer else verdict
    for finding in findings:
        yield f'{name}{finding.kind}: {finding.text}'
    if answer and not section.verdict:
        yield f'{name}result: {answer}'
    for table in () if brief else section.tables:
        yield from (f'{name}{line}' for line in _table_lines(table))
    for remark in () if brief else section.remarks:
        yield f'{name}remark: {remark}'


def _joined(text: str, more: str) -> str:
    """Join two texts after a semicolon, or after a full stop if the second is a sentence."""
    return f'{text.removesuffix(".")}{"." if more[0].isupper() else ";"} {more}'


def _table_lines(table: doc.Table) -> Iterator[str]:
    """Yield a line for each row, or for each fact."""
    for row in table.rows:
        facts = list(replace(table, rows=(row,)).facts())
        if table.layout == doc.Layout.LINES:
            yield from (f'{column}: {cell.with_unit()}' for _, column, cell in facts)
        elif facts:
            values = '; '.join(f'{column}: {cell.with_unit()}' for _, column, cell in facts)
            yield ': '.join(filter(None, [facts[0][0], values]))


def _render_section(section: doc.Section, console: Console, *, brief: bool) -> None:
    style = _VERDICT_STYLES[section.verdict]
    if section.name:
        verdict = (f'{OUTCOME[section.verdict].upper()} ', style) if section.verdict else ''
        console.print(Text.assemble(verdict, (section.name, 'bold'), overflow='fold'))
    sentences = [_bullet(finding.text, style) for finding in section.findings]
    if section.answer:
        first = 0 if section.verdict == Verdict.PASS else len(sentences)
        sentences.insert(first, _bullet(section.answer))
    console.print(*sentences, sep='\n', end='\n' * bool(sentences))
    for table in () if brief else filter(lambda table: table.rows, section.tables):
        if table.layout == doc.Layout.ROWS:
            console.print()
            console.print(_rows(table, console))
        else:
            console.print(_values(table))
    remarks = () if brief else section.remarks
    if remarks:
        console.print()
    for remark in remarks:
        console.print(_bullet(remark))
    console.print()


def _bullet(sentence: str, style: str = '') -> Table:
    """Return a sentence with a bullet and a hanging indent."""
    item = Table.grid(padding=(0, 1))
    item.add_row(Text('•', style), Text(sentence, overflow='fold'))
    return item


def _values(table: doc.Table) -> RenderableType:
    """Return the values of a single row with their labels, below its subject."""
    grid = Table.grid(padding=(0, 2))
    if subject := table.rows[0][0].text:
        grid.add_row(Text(table.columns[0], 'dim'), Text(subject, 'bold', overflow='fold'))
    for _, column, cell in table.facts():
        if cell.says:
            grid.add_row(Text(column, 'dim'), _styled(cell, cell.with_unit()))
    return grid


def _rows(table: doc.Table, console: Console) -> RenderableType:
    """Return rows below headings, or where there is no room, each row as values with labels.

    Words may wrap, but only between them, and numbers may not.
    """
    table = table.below_headings()
    columns = []
    for k, column in enumerate(table.columns):
        heading = column if table.is_words(k) else '\n'.join(column.rsplit(' ', 1))
        texts = Text('\n'.join([heading, *(row[k].text for row in table.rows)]))
        longest_word, widest = texts.__rich_measure__(console, console.options)
        columns.append((heading, longest_word if table.is_words(k) else widest, widest))
    room = console.width - sum(least + _PADDING for _, least, _ in columns)
    if room < 0:
        return _transposed(table)
    rich_table = Table(
        box=box.SIMPLE_HEAD, show_edge=False, padding=(0, 1, 0, 0), header_style='dim'
    )
    for k, (heading, least, widest) in enumerate(columns):
        width = min(widest, least + room)
        room -= width - least
        words = table.is_words(k)
        rich_table.add_column(
            Text(heading), width=width, justify='left' if words else 'right', no_wrap=not words
        )
    for row in table.rows:
        rich_table.add_row(*(_styled(cell, cell.text) for cell in row))
    return rich_table


def _transposed(table: doc.Table) -> RenderableType:
    """Return each row as its subject, with the values and their labels below it."""
    blocks: list[RenderableType] = []
    for subject, *cells in table.rows:
        blocks.append(Text(subject.text, _TONE_STYLES[subject.tone], overflow='fold'))
        grid = Table.grid(padding=(0, 2))
        for column, cell in zip(table.columns[1:], cells, strict=True):
            if cell.says:
                grid.add_row(Text(f'  {column}', 'dim'), _styled(cell, cell.text))
        blocks.append(grid)
    return Group(*blocks)


def _styled(cell: doc.Cell, text: str) -> Text:
    return Text(text, _TONE_STYLES[cell.tone])

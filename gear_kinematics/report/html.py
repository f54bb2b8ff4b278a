"""Writes a report as a self-contained HTML page."""

import json
from collections.abc import Iterator, Sequence
from html import escape

from gear_kinematics.report.document import (
    OUTCOME,
    Cell,
    Document,
    Layout,
    Section,
    Table,
    Verdict,
)
from gear_kinematics.report.interactive import interactive
from gear_kinematics.report.mechanism import Drawings
from gear_kinematics.report.page import page

_STACKED_HEIGHT = 11.5  # rem, of each panel
_ROW_HEIGHT = 30.0  # rem, of each row of panels
_HEIGHT = 34.0  # rem


def to_html(document: Document) -> str:
    """Write a report as a self-contained page, with plotly.js if it has figures.

    Raises:
        ModuleNotFoundError: if it has figures and plotly is not installed.
    """
    sections = document.sections
    scripts = ['page.js'] if any(section.figure for section in sections) else []
    if any(section.mechanism for section in sections):
        scripts.append('motion.js')
    kind = OUTCOME[document.verdict] if document.verdict else document.title
    about = document.totals if len(sections) != 1 else ''
    names = about or ', '.join(section.name for section in sections)
    return page(': '.join(filter(None, [kind, names])), ''.join(_body(document)), scripts=scripts)


def _body(document: Document) -> Iterator[str]:
    several = len(document.sections) > 1
    yield f'<header><h1>{_badge(document.verdict)}{escape(document.title)}</h1>'
    if document.totals:
        yield f'<p>{escape(document.totals)}</p>'
    yield '</header>\n<main>\n'
    if several and document.summary:
        links = [f'#section-{k}' for k in range(len(document.sections))]
        yield f'<section id="top">{_rows(document.summary, links)}</section>\n'
    drawings = Drawings()
    for k, section in enumerate(document.sections):
        yield f'<section id="section-{k}">\n'
        yield from _section(section, f'figure-{k}', drawings)
        if several:
            yield '<p><a href="#top">to the summary</a></p>\n'
        yield '</section>\n'
    yield f'</main>\n{drawings.shapes()}'


def _section(section: Section, figure: str, drawings: Drawings) -> Iterator[str]:
    if section.name:
        yield f'<h2>{_badge(section.verdict)}{escape(section.name)}</h2>\n'
    head, *tables = section.tables
    yield _table(head)
    yield _sentences([finding.text for finding in section.findings], section.verdict or '')
    if section.figure:
        moving = section.mechanism
        yield '<div class="moving">\n' if moving else ''
        if moving:
            yield from drawings.moving(moving, figure)
        yield from _figure(section, figure)
        yield '</div>\n' if moving else ''
    yield f'<div class="drawing">{section.drawing}</div>\n' if section.drawing else ''
    for table in tables:
        yield _table(table)
    yield _sentences(section.remarks, '')


def _badge(verdict: Verdict | None) -> str:
    return f'<span class="badge {verdict}">{OUTCOME[verdict]}</span> ' if verdict else ''


def _sentences(sentences: Sequence[str], kind: str) -> str:
    items = ''.join(f'<li>{escape(sentence)}</li>' for sentence in sentences)
    return f'<ul class="{f"remarks {kind}".strip()}">{items}</ul>\n' if items else ''


def _figure(section: Section, name: str) -> Iterator[str]:
    """Write the data of a figure, which page.js draws, in a script element."""
    figure = section.figure
    if not figure:
        return
    data = json.dumps(
        interactive(figure, section.mechanism), allow_nan=False, separators=(',', ':')
    )
    # It must not contain the end tag of the script element.
    for char in '<>&':
        data = data.replace(char, f'\\u{ord(char):04x}')
    each = _STACKED_HEIGHT if figure.stacked else _ROW_HEIGHT
    height = max(_HEIGHT, each * figure.shape[0])
    yield f'<div class="figure" id="{name}" style="height: {height:g}rem">'
    yield '<noscript>Plots need JavaScript.</noscript></div>\n'
    yield f'<script type="application/json" data-figure="{name}">{data}</script>\n'


def _table(table: Table) -> str:
    if not table.rows:
        return ''
    return _rows(table) if table.layout == Layout.ROWS else _values(table)


def _values(table: Table) -> str:
    """Write a table of one row as labelled values."""
    subject = table.rows[0][0].text
    heading = f'<h3>{escape(table.columns[0])} {escape(subject)}</h3>\n' if subject else ''
    items = ''.join(
        f'<div><dt>{escape(column)}</dt>'
        f'<dd class="{cell.tone}">{escape(cell.with_unit())}</dd></div>'
        for _, column, cell in table.facts()
    )
    return f'{heading}<dl class="{table.layout}">{items}</dl>\n'


def _rows(table: Table, links: Sequence[str] = ()) -> str:
    """Write a table; the first cells of rows are links, if any are given."""
    table = table.without_empty_columns()
    classes = ['words' if table.is_words(k) else 'number' for k in range(len(table.columns))]
    head = ''.join(
        f'<th scope="col" class="{kind}">{escape(column)}</th>'
        for kind, column in zip(classes, table.columns, strict=True)
    )
    rows = ''.join(
        f'<tr>{_row(row, classes, links[k] if links else "")}</tr>\n'
        for k, row in enumerate(table.rows)
    )
    return f'<div class="scroll"><table>\n<tr>{head}</tr>\n{rows}</table></div>\n'


def _row(row: Sequence[Cell], classes: Sequence[str], link: str) -> str:
    subject, *cells = row
    name = escape(subject.as_subject())
    linked = f'<a href="{link}">{name}</a>' if link else name
    return f'<th scope="row" class="{classes[0]} {subject.tone}">{linked}</th>' + ''.join(
        f'<td class="{kind} {cell.tone}">{escape(cell.in_row_of(subject))}</td>'
        for kind, cell in zip(classes[1:], cells, strict=True)
    )

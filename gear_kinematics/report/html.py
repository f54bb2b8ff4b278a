"""Writes a report as a self-contained HTML page."""

import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from html import escape

from gear_kinematics.report.document import (
    OUTCOME,
    Cell,
    Document,
    Finding,
    Layout,
    Origin,
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
_FEW_FINDINGS = 3
"""Most findings above a figure, beside the first."""
_FIRST = (Verdict.FAIL, Verdict.UNUSABLE, Verdict.PASS, None)
"""Verdicts in the order of a page."""


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
    order = sorted(range(len(document.sections)), key=lambda k: _rank(document.sections[k]))
    several = len(order) > 1
    yield from _header(document)
    yield '<main>\n'
    if several and document.summary:
        listed = [k for k in order if k < len(document.summary.rows)]  # not a comparison
        links = [f'#section-{k}' for k in listed]
        rows = tuple(document.summary.rows[k] for k in listed)
        yield f'<section id="top">{_rows(replace(document.summary, rows=rows), links)}</section>\n'
    drawings = Drawings()
    for k in order:
        section = document.sections[k]
        yield f'<section id="section-{k}">\n'
        if several and section.name:
            yield f'<h2>{_badge(section.verdict)}{escape(section.name)}</h2>\n'
        yield from (_pictured if section.picture_first else _tabled)(section, k, drawings)
        if several:
            yield '<p><a href="#top">to the summary</a></p>\n'
        yield '</section>\n'
    yield f'</main>\n{_footer(document.origin)}{drawings.shapes()}'


def _rank(section: Section) -> tuple[bool, int]:
    """Return what sorts sections: a comparison is first, and failed before passed."""
    return not section.leads, _FIRST.index(section.verdict)


def _header(document: Document) -> Iterator[str]:
    name, verdict, about = document.title, document.verdict, document.totals
    if len(document.sections) == 1 and (only := document.sections[0]).name:
        name, verdict, about = only.name, only.verdict, document.title
    yield f'<header><h1>{_badge(verdict)}{escape(name)}</h1>'
    yield f'<p>{escape(about)}</p>' if about else ''
    yield '</header>\n'


def _pictured(section: Section, number: int, drawings: Drawings) -> Iterator[str]:
    """Write the findings, the first of them large, the figure, and then the folded tables."""
    first, *others = section.findings or (None,)
    figure = f'figure-{number}'
    linked = figure if section.figure else ''
    if first:
        yield f'<p class="first {section.verdict or ""}">{_told(first, linked)}</p>\n'
    further = _list([_told(finding, linked) for finding in others], section.verdict or '')
    if len(others) > _FEW_FINDINGS:  # the figure is to be on the first screen
        yield _folded(f'{len(others)} more findings', further)
    else:
        yield further
    yield _table(section.key) if section.key else ''
    yield from _drawn(section, figure, drawings)
    yield _list(map(escape, section.remarks), '')
    head, *tables = section.tables
    yield _table(head)
    yield _folded('Tables', ''.join(map(_table, tables)))


def _tabled(section: Section, number: int, drawings: Drawings) -> Iterator[str]:
    """Write the first table, the figure, and then the other tables."""
    head, *tables = section.tables
    yield _table(head)
    yield _list([_told(finding) for finding in section.findings], section.verdict or '')
    yield from _drawn(section, f'figure-{number}', drawings)
    yield f'<div class="drawing">{section.drawing}</div>\n' if section.drawing else ''
    for table in tables:
        yield _table(table)
    yield _list(map(escape, section.remarks), '')


def _drawn(section: Section, figure: str, drawings: Drawings) -> Iterator[str]:
    if not section.figure:
        return
    if section.mechanism:
        yield '<div class="moving">\n'
        yield from drawings.moving(section.mechanism, figure)
    yield from _figure(section, figure)
    yield '</div>\n' if section.mechanism else ''


def _folded(name: str, content: str) -> str:
    return f'<details><summary>{name}</summary>\n{content}</details>\n' if content else ''


def _badge(verdict: Verdict | None) -> str:
    return f'<span class="badge {verdict}">{OUTCOME[verdict]}</span> ' if verdict else ''


def _told(finding: Finding, figure: str = '') -> str:
    """Write a finding, as a link to its moment in the figure, if there is one."""
    text = escape(finding.text)
    if finding.time is None or not figure:
        return text
    return f'<a href="#{figure}" data-time="{finding.time:.9g}">{text}</a>'


def _list(items: Iterable[str], kind: str) -> str:
    """Write a list of sentences in HTML."""
    written = ''.join(f'<li>{item}</li>' for item in items)
    return f'<ul class="{f"remarks {kind}".strip()}">{written}</ul>\n' if written else ''


def _footer(origin: Origin | None) -> str:
    if not origin:
        return ''
    configs = ''.join(
        f'<div><dt>SHA-256 of {escape(name)}</dt><dd>{digest}</dd></div>'
        for name, digest in origin.configs
    )
    return (
        f'<footer><dl><div><dt>gear_kinematics</dt><dd>{escape(origin.version)}</dd></div>'
        f'<div><dt>made</dt><dd>{escape(origin.date)}</dd></div>'
        f'<div><dt>command</dt><dd>{escape(origin.command)}</dd></div>{configs}</dl></footer>\n'
    )


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
    rows = figure.shape[0] * _ROW_HEIGHT
    height = max(_HEIGHT, sum(figure.heights) * _STACKED_HEIGHT if figure.stacked else rows)
    yield f'<div class="figure" id="{name}" style="--height: {height:g}rem">'
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
        f'<tr>{_row(row, classes, table.columns, links[k] if links else "")}</tr>\n'
        for k, row in enumerate(table.rows)
    )
    return f'<div class="scroll"><table>\n<tr>{head}</tr>\n{rows}</table></div>\n'


def _row(row: Sequence[Cell], classes: Sequence[str], columns: Sequence[str], link: str) -> str:
    subject, *cells = row
    name = escape(subject.as_subject())
    linked = f'<a href="{link}">{name}</a>' if link else name
    return f'<th scope="row" class="{classes[0]} {subject.tone}">{linked}</th>' + ''.join(
        f'<td class="{kind} {cell.tone}" data-column="{escape(column)}">'
        f'{escape(cell.in_row_of(subject))}</td>'
        for kind, column, cell in zip(classes[1:], columns[1:], cells, strict=True)
    )

"""Writes a report as a self-contained HTML page."""

import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from html import escape

from gear_kinematics.report.document import (
    OUTCOME,
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
from gear_kinematics.report.page import page, resource

_STACKED_HEIGHT = 11.5  # rem, of each panel
_ROW_HEIGHT = 30.0  # rem, of each row of panels
_HEIGHT = 34.0  # rem
_FEW_FINDINGS = 3
"""Most findings above a figure, beside the first."""


def to_html(document: Document) -> str:
    """Write a report as a self-contained page, with plotly.js if it has figures.

    Raises:
        ModuleNotFoundError: if it has figures and plotly is not installed.
    """
    scripts = []
    if any(section.figure for section in document.sections):
        from plotly.offline import get_plotlyjs  # noqa: PLC0415, an extra

        scripts = [get_plotlyjs(), resource('page.js')]
    if any(section.mechanism for section in document.sections):
        scripts.append(resource('motion.js'))
    kind = OUTCOME[document.verdict] if document.verdict else document.title
    about = document.totals if len(document.sections) != 1 else ''
    names = about or ', '.join(section.name for section in document.sections)
    return page(': '.join(filter(None, [kind, names])), ''.join(_body(document)), scripts)


def _body(document: Document) -> Iterator[str]:
    order = document.order
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
        yield from _section(section, k, drawings)
        if several:
            yield '<p><a href="#top">to the summary</a></p>\n'
        yield '</section>\n'
    yield f'</main>\n{_footer(document.origin)}{drawings.shapes()}'


def _header(document: Document) -> Iterator[str]:
    name, verdict, about = document.title, document.verdict, document.totals
    if any(section.verdict == Verdict.FAIL for section in document.sections):
        verdict = Verdict.FAIL  # which an unusable recording must not hide
    if len(document.sections) == 1 and (only := document.sections[0]).name:
        name, verdict, about = only.name, only.verdict, document.title
    yield f'<header><h1>{_badge(verdict)}{escape(name)}</h1>'
    yield f'<p>{escape(about)}</p>' if about else ''
    yield '</header>\n'


def _section(section: Section, number: int, drawings: Drawings) -> Iterator[str]:
    """Write the parts of a section, with a figure that comes first above folded tables."""
    head, *tables = section.tables
    name = f'figure-{number}'
    figure = ''.join(_figure(section, name, drawings))
    findings = [_sentence(finding, name if figure else '') for finding in section.findings]
    kind = section.verdict or ''
    remarks = _list(map(escape, section.remarks), '')
    below = ''.join(map(_table, tables))
    answer = f'<p>{escape(section.answer)}</p>\n' if section.answer else ''
    if not section.picture_first:
        drawing = f'<div class="drawing">{section.drawing}</div>\n' if section.drawing else ''
        yield from (answer, _table(head), _list(findings, kind), figure, drawing, below, remarks)
        return
    if findings:
        yield f'<p class="first {kind}">{findings.pop(0)}</p>\n'
    yield answer
    others = _list(findings, kind)
    many = len(findings) > _FEW_FINDINGS  # the figure is to be on the first screen
    yield _folded(f'{len(findings)} more findings', others) if many else others
    yield _table(section.key) if section.key else ''
    yield from (figure, remarks, _table(head), _folded('Tables', below))


def _figure(section: Section, name: str, drawings: Drawings) -> Iterator[str]:
    """Write the data of a figure, which page.js draws, beside the mechanism that moves with it."""
    figure, mechanism = section.figure, section.mechanism
    if not figure:
        return
    data = json.dumps(interactive(figure, mechanism), allow_nan=False, separators=(',', ':'))
    # It must not contain the end tag of the script element.
    for char in '<>&':
        data = data.replace(char, f'\\u{ord(char):04x}')
    rows = figure.shape[0] * _ROW_HEIGHT
    height = max(_HEIGHT, sum(figure.heights) * _STACKED_HEIGHT if figure.stacked else rows)
    if mechanism:
        yield '<div class="moving">\n'
        yield from drawings.moving(mechanism, name)
    yield f'<div class="figure" id="{name}" style="--height: {height:g}rem">'
    yield '<noscript>Plots need JavaScript.</noscript></div>\n'
    yield f'<script type="application/json" data-figure="{name}">{data}</script>\n'
    yield '</div>\n' if mechanism else ''


def _folded(name: str, content: str) -> str:
    return f'<details><summary>{name}</summary>\n{content}</details>\n' if content else ''


def _badge(verdict: Verdict | None) -> str:
    return f'<span class="badge {verdict}">{OUTCOME[verdict]}</span> ' if verdict else ''


def _sentence(finding: Finding, figure: str) -> str:
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
        if cell.says
    )
    return f'{heading}<dl class="{table.layout}">{items}</dl>\n'


def _rows(table: Table, links: Sequence[str] = ()) -> str:
    """Write a table; the first cells of rows are links, if any are given."""
    table = table.below_headings()
    classes = ['words' if table.is_words(k) else 'number' for k in range(len(table.columns))]
    head = ''.join(
        f'<th scope="col" class="{kind}">{escape(column)}</th>'
        for kind, column in zip(classes, table.columns, strict=True)
    )
    rows = []
    for k, (subject, *cells) in enumerate(table.rows):
        name = escape(subject.text)
        linked = f'<a href="{links[k]}">{name}</a>' if links else name
        first = f'<th scope="row" class="{classes[0]} {subject.tone}">{linked}</th>'
        others = ''.join(
            f'<td class="{kind} {cell.tone}" data-column="{escape(column)}">'
            f'{escape(cell.text)}</td>'
            for kind, column, cell in zip(classes[1:], table.columns[1:], cells, strict=True)
        )
        rows.append(f'<tr>{first}{others}</tr>\n')
    return f'<div class="scroll"><table>\n<tr>{head}</tr>\n{"".join(rows)}</table></div>\n'

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Writes a report as a self-contained HTML page."""

import json
from collections.abc import Iterator, Sequence
from html import escape

from gear_kinematics.report import document as doc
from gear_kinematics.report.document import OUTCOME, Verdict
from gear_kinematics.report.interactive import interactive
from gear_kinematics.report.mechanism import Drawings, MovingMechanism
from gear_kinematics.report.page import page, resource

_PANEL_HEIGHT = 11.5  # rem, of each of several stacked panels
_HEIGHT = 34.0  # rem, least height of all panels together
_FEW_SENTENCES = 6  # most remarks, or findings after the first, that are not folded


def to_html(document: doc.Document) -> str:
    """Write a report as a self-contained page; ModuleNotFoundError if its figures lack plotly."""
    scripts, body = [], ''.join(_body(document.in_order()))
    if any(section.figure for section in document.sections):
        from plotly.offline import get_plotlyjs  # noqa: PLC0415, an extra

        scripts = [get_plotlyjs(), resource('page.js')]
    if any(section.mechanism for section in document.sections):
        scripts.append(resource('motion.js'))
    kind = OUTCOME[document.verdict] if document.verdict else document.title
    about = document.totals if len(document.sections) != 1 else ''
    names = about or ', '.join(section.name for section in document.sections)
    return page(': '.join(filter(None, [kind, names])), body, scripts)


def _body(document: doc.Document) -> Iterator[str]:
    several = len(document.sections) > 1
    yield from _header(document)
    yield '<main>\n'
    if several and document.summary:
        links = [f'#section-{k}' for k, one in enumerate(document.sections) if not one.leads]
        yield f'<section id="top">{_rows(document.summary, links)}</section>\n'
    drawings = Drawings()
    for k, section in enumerate(document.sections):
        yield f'<section id="section-{k}">\n'
        if several and section.name:
            yield f'<h2>{_badge(section.verdict)}{escape(section.name)}</h2>\n'
        yield from _section(section, k, drawings)
        yield '</section>\n'
    yield f'</main>\n{_footer(document.origin)}{drawings.shapes()}'


def _header(document: doc.Document) -> Iterator[str]:
    name, verdict, about = document.title, document.verdict, document.totals
    if any(section.verdict == Verdict.FAIL for section in document.sections):
        verdict = Verdict.FAIL  # an unusable recording must not hide it
    if len(document.sections) == 1 and (only := document.sections[0]).name:
        name, verdict, about = only.name, only.verdict, document.title
    yield f'<header><h1>{_badge(verdict)}{escape(name)}</h1>'
    yield f'<p>{escape(about)}</p>' if about else ''
    yield '</header>\n'


def _section(section: doc.Section, number: int, drawings: Drawings) -> Iterator[str]:
    name, kind = f'figure-{number}', section.verdict or ''
    moments = name if section.figure and section.figure.stacked else ''
    findings = [_sentence(finding, moments) for finding in section.findings]
    if findings and section.verdict != Verdict.PASS:
        yield f'<p class="first {kind}">{findings.pop(0)}</p>\n'
    yield f'<p>{escape(section.answer)}</p>\n' if section.answer else ''
    yield _list(findings, f'{len(findings)} more findings')
    yield _table(section.key) if section.key else ''
    yield from _figure(section.figure, section.mechanism, name, drawings)
    yield from _figure(section.below, None, name, drawings)
    yield _list(list(map(escape, section.remarks)), f'{len(section.remarks)} remarks')
    head, *tables = section.tables
    below = ''.join(map(_table, tables))
    yield _table(head) + (_folded('Tables', below) if len(tables) > 1 else below)


def _figure(
    figure: doc.Figure | None, mechanism: MovingMechanism | None, name: str, drawings: Drawings
) -> Iterator[str]:
    """Write a figure next to the mechanism that moves with it."""
    if not figure:
        return
    if not figure.stacked:
        yield '<div class="panels">\n'
        for k, panel in enumerate(figure.panels):
            yield f'<figure><figcaption>{escape(panel.title)}</figcaption>'
            yield f'{_legend([panel])}{_plot([panel], None, f"{name}-{k}")}</figure>\n'
        yield '</div>\n'
        return
    height = max(_HEIGHT, _PANEL_HEIGHT * len(figure.panels))
    plot = _plot(figure.panels, mechanism, name, f' style="--height: {height:g}rem"')
    if mechanism:
        yield '<div class="moving">\n'
        yield from drawings.moving(mechanism, name)
        yield f'<div>{_legend(figure.panels)}{plot}</div>\n</div>\n'
    else:
        yield _legend(figure.panels) + plot


def _plot(
    panels: Sequence[doc.Panel], mechanism: MovingMechanism | None, name: str, style: str = ''
) -> str:
    """Write the data of a plot, which page.js draws."""
    data = json.dumps(interactive(panels, mechanism), allow_nan=False, separators=(',', ':'))
    # It must not contain the end tag of the script element.
    for char in '<>&':
        data = data.replace(char, f'\\u{ord(char):04x}')
    return (
        f'<div class="figure" id="{name}"{style}>'
        '<noscript>Plots need JavaScript.</noscript></div>\n'
        f'<script type="application/json" data-figure="{name}">{data}</script>\n'
    )


def _legend(panels: Sequence[doc.Panel]) -> str:
    lines = {line.name: line for panel in panels if panel.has_legend for line in panel.lines}
    items = ''.join(
        f'<li style="--line: var(--{line.pen})">{escape(name)}</li>'
        for name, line in lines.items()
    )
    return f'<ul class="legend">{items}</ul>\n' if items else ''


def _folded(name: str, content: str) -> str:
    return f'<details><summary>{name}</summary>\n{content}</details>\n' if content else ''


def _badge(verdict: Verdict | None) -> str:
    return f'<span class="badge {verdict}">{OUTCOME[verdict]}</span> ' if verdict else ''


def _sentence(finding: doc.Sentence, figure: str) -> str:
    """Write a finding; if it refers to a moment in the figure, as a link to it."""
    text = escape(finding.text)
    if finding.time is None or not figure:
        return text
    return f'<a href="#{figure}" data-time="{finding.time:.9g}">{text}</a>'


def _list(items: Sequence[str], name: str) -> str:
    """Write a list of sentences in HTML, folded if they would push away what is below them."""
    written = ''.join(f'<li>{item}</li>' for item in items)
    listed = f'<ul class="remarks">{written}</ul>\n' if written else ''
    return _folded(name, listed) if len(items) > _FEW_SENTENCES else listed


def _footer(origin: doc.Origin | None) -> str:
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


def _table(table: doc.Table) -> str:
    if not table.rows:
        return ''
    return _rows(table) if table.layout == doc.Layout.ROWS else _values(table)


def _values(table: doc.Table) -> str:
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


def _rows(table: doc.Table, links: Sequence[str] = ()) -> str:
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
            f'<td class="{kind} {cell.tone}">{escape(cell.text)}</td>'
            for kind, cell in zip(classes[1:], cells, strict=True)
        )
        rows.append(f'<tr>{first}{others}</tr>\n')
    return f'<div class="scroll"><table>\n<tr>{head}</tr>\n{"".join(rows)}</table></div>\n'

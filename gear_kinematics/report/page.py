"""The shell of a page that needs neither network nor server, and what pages are made of."""

import base64
import hashlib
import json
from collections.abc import Iterator, Sequence
from html import escape
from importlib.resources import files
from typing import Any

from gear_kinematics.report.wording import Cell, Table


def page(title: str, body: str, *, scripts: Sequence[str] = ()) -> str:
    """Write a page that holds all it needs, with plotly.js where there are scripts.

    Args:
        title: as text.
        body: as HTML, from functions such as those below.
        scripts: their names beside this module, `page.js` where there are figures.

    Raises:
        ModuleNotFoundError: if there are some, and plotly is not installed.
    """
    sources = [_plotly_js(), *map(_resource, scripts)] if scripts else []
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{_policy(sources)}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<title>{escape(title)}</title>\n'
        f'<style>\n{_resource("page.css")}</style>\n</head>\n<body>\n{body}'
        + ''.join(f'<script>{script}</script>\n' for script in sources)
        + '</body>\n</html>\n'
    )


def table(content: Table, links: Sequence[str] = ()) -> str:
    """Write a table, with the first cell of each row as a link where there are any."""
    if not content.rows:
        return ''
    content = content.without_empty_columns()
    classes = [
        'words' if k == 0 or column in content.prose else 'number'
        for k, column in enumerate(content.columns)
    ]
    head = ''.join(
        f'<th scope="col" class="{kind}">{escape(column)}</th>'
        for kind, column in zip(classes, content.columns, strict=True)
    )
    rows = ''.join(
        f'<tr>{_row(row, classes, links[k] if links else "")}</tr>\n'
        for k, row in enumerate(content.rows)
    )
    return f'<div class="scroll"><table>\n<tr>{head}</tr>\n{rows}</table></div>\n'


def _row(row: Sequence[Cell], classes: Sequence[str], link: str) -> str:
    subject, *cells = row
    name = escape(subject.as_subject())
    linked = f'<a href="{link}">{name}</a>' if link else name
    return f'<th scope="row" class="words">{linked}</th>' + ''.join(
        f'<td class="{kind} {cell.tone}">{escape(cell.in_row_of(subject))}</td>'
        for kind, cell in zip(classes[1:], cells, strict=True)
    )


def definitions(content: Table) -> str:
    """Write a table of one row as labelled values."""
    subject = content.rows[0][0].text
    heading = f'<h3>{escape(content.columns[0])} {escape(subject)}</h3>\n' if subject else ''
    items = ''.join(
        f'<div><dt>{escape(column)}</dt>'
        f'<dd class="{cell.tone}">{escape(cell.with_unit())}</dd></div>'
        for _, column, cell in content.facts()
    )
    return f'{heading}<dl>{items}</dl>\n'


def figure(name: str, plots: dict[str, Any], kind: str = '') -> Iterator[str]:
    """Write a figure for page.js to draw.

    Args:
        name: of the element.
        plots: for plotly, without colours; what else is in it is for other scripts.
        kind: what the style sheet knows it by, besides.
    """
    data = json.dumps(plots, allow_nan=False, separators=(',', ':'))
    # Nothing in it may look like the end of the script element.
    for char in '<>&':
        data = data.replace(char, f'\\u{ord(char):04x}')
    classes = f'figure {kind}'.strip()
    yield f'<div class="{classes}" id="{name}"><noscript>Plots need JavaScript.</noscript></div>\n'
    yield f'<script type="application/json" data-figure="{name}">{data}</script>\n'


def _policy(scripts: Sequence[str]) -> str:
    """Let the browser run these scripts alone, and load nothing from anywhere."""
    none = ["'none'"]
    hashes = [
        f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'"
        for script in scripts
    ]
    return (
        f"default-src 'none'; script-src {' '.join(hashes or none)}; "
        "style-src 'unsafe-inline'; img-src data: blob:"
    )


def _plotly_js() -> str:
    # Large, and of use here only.
    from plotly.offline import get_plotlyjs  # noqa: PLC0415, an extra

    return str(get_plotlyjs())


def _resource(name: str) -> str:
    return files('gear_kinematics.report').joinpath(name).read_text('utf-8')

"""Lost motion as one page, which needs neither network nor server."""

import math
from collections.abc import Iterator, Sequence
from html import escape
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.lost_motion import wording
from gear_kinematics.lost_motion.curves import Panel, panels
from gear_kinematics.lost_motion.report import LostMotionReport
from gear_kinematics.report.page import definitions, figure, page, table

_GAP = 0.12
"""Between two plots, of the figure's width."""
_COLOURS = {'forward': 'angle', 'backward': 'error', 'model': 'text', 'unknown': 'faint'}
"""Of the style sheet, by what a line is."""


def to_html(reports: Sequence[LostMotionReport]) -> str:
    """Write the reports as a page that holds all it needs, plotly.js included.

    Raises:
        ModuleNotFoundError: if plotly is not installed.
    """
    names = ', '.join(map(wording.name, reports))
    return page(f'lost motion: {names}', ''.join(_body(reports)), scripts=['page.js'])


def _body(reports: Sequence[LostMotionReport]) -> Iterator[str]:
    yield '<header><h1>gearkin lost-motion</h1></header>\n<main>\n'
    if len(reports) > 1:
        links = [f'#recording-{k}' for k in range(len(reports))]
        yield f'<section id="top">{table(wording.summary_table(reports), links)}</section>\n'
    for k, report in enumerate(reports):
        yield f'<section id="recording-{k}">\n<h2>{escape(wording.name(report))}</h2>\n'
        yield definitions(wording.head(report))
        for content in wording.tables(report):
            yield table(content)
        yield from figure(f'figure-{k}', plots(panels(report)), 'panels')
        items = ''.join(f'<li>{escape(remark)}</li>' for remark in wording.remarks(report))
        yield f'<ul class="remarks">{items}</ul>\n</section>\n'
    yield '</main>\n'


def plots(drawn: Sequence[Panel]) -> dict[str, Any]:
    """Describe panels beside each other for plotly."""
    layout: dict[str, Any] = {
        'hovermode': 'closest',
        'showlegend': True,
        'legend': {'orientation': 'h', 'y': -0.18},
        'shapes': [],
        'annotations': [],
    }
    data = []
    named = set()
    width = (1.0 + _GAP) / max(len(drawn), 1)
    for k, panel in enumerate(drawn, start=1):
        left = (k - 1) * width
        kind = 'linear' if panel.low is None else 'log'
        layout[f'xaxis{k}'] = {
            'title': {'text': escape(panel.x_label)},
            'type': kind,
            'domain': [left, min(left + width - _GAP, 1.0)],
            'anchor': f'y{k}',
        }
        layout[f'yaxis{k}'] = {
            'title': {'text': escape(panel.y_label)},
            'anchor': f'x{k}',
            'type': kind,
        }
        if panel.low is not None:
            top = max(float(np.max(line.y)) for line in panel.lines)
            layout[f'yaxis{k}']['range'] = [math.log10(panel.low), math.log10(2.0 * top)]
        layout['annotations'].append(
            {
                'text': escape(panel.title),
                'xref': f'x{k} domain',
                'yref': f'y{k} domain',
                'x': 0.0,
                'y': 1.0,
                'xanchor': 'left',
                'yanchor': 'bottom',
                'showarrow': False,
            }
        )
        for line in panel.lines:
            trace = {
                'name': line.name,
                'meta': _COLOURS[line.kind],
                'legendgroup': line.name,
                'showlegend': line.name not in named,
                'x': _rounded(line.x),
                'y': _rounded(line.y),
                'xaxis': f'x{k}',
                'yaxis': f'y{k}',
            }
            if line.points:
                trace |= {'mode': 'markers', 'marker': {'size': 3}}
            if line.kind == 'model':
                trace['line'] = {'dash': 'dash'}
            named.add(line.name)
            data.append(trace)
        layout['shapes'] += [_mark(place, k) for place, _ in panel.marks]
        layout['annotations'] += [_note(*mark, k) for mark in panel.marks if mark[1]]
    return {'data': data, 'layout': layout}


def _mark(place: float, k: int) -> dict[str, Any]:
    return {
        'type': 'line',
        'meta': 'faint',
        'xref': f'x{k}',
        'x0': place,
        'x1': place,
        'yref': f'y{k} domain',
        'y0': 0,
        'y1': 1,
    }


def _note(place: float, text: str, k: int) -> dict[str, Any]:
    """Name a mark on a logarithmic axis."""
    return {
        'text': escape(text),
        'textangle': -90,
        'xref': f'x{k}',
        'x': math.log10(place),
        'yref': f'y{k} domain',
        'y': 0.99,
        'xanchor': 'right',
        'yanchor': 'top',
        'showarrow': False,
    }


def _rounded(values: NDArray[np.float64]) -> list[float]:
    """Drop the digits that no plot shows."""
    return [float(f'{value:.6g}') for value in values.tolist()]

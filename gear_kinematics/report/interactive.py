"""Converts figures for plotly, without colours, which page.js adds from the style sheet."""

import math
from html import escape
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gear_kinematics.report.document import (
    FEW,
    Figure,
    Line,
    Panel,
    Pen,
)
from gear_kinematics.report.mechanism import MovingMechanism
from gear_kinematics.report.symmetric_log import SymmetricLog

_GAP = 0.12
"""Gap between panels side by side / width of the figure."""
_STACK_GAP = 0.2
"""Gap between stacked panels / height of a panel with its gap."""
_ROW_GAP, _TICK_GAP = 0.2, 0.3
"""Gap between rows of panels / height of the figure, without and with upright texts of ticks."""


def interactive(figure: Figure, mechanism: MovingMechanism | None) -> dict[str, Any]:
    """Return the data and the layout of a figure.

    Args:
        figure: the figure.
        mechanism: moves with the x axis of the figure.

    Returns:
        `data` and `layout` of plotly; `time`, the x of all stacked lines without one of their own;
        `turned`, the angles of rotor and output in degrees, if there is a mechanism.
    """
    panels = figure.panels
    # The legend is above all curves, beside the buttons on the right.
    legend = {'orientation': 'h', 'xref': 'container', 'x': 0.0, 'xanchor': 'left'}
    legend |= {'yref': 'container', 'y': 1.0, 'yanchor': 'top'}
    layout: dict[str, Any] = {'shapes': [], 'annotations': [], 'legend': legend}
    layout['showlegend'] = any(panel.has_legend for panel in panels)
    layout['hovermode'] = 'x unified' if figure.stacked else 'closest'
    plots: dict[str, Any] = {'data': [], 'layout': layout}
    time = None
    if figure.stacked:
        time = mechanism.time if mechanism else panels[0].lines[0].x
        plots['time'] = _rounded(time)
    named: set[str] = set()
    for k, panel in enumerate(panels, 1):
        x, y = 'x' if figure.stacked else f'x{k}', f'y{k}'
        scale = SymmetricLog.of(panel) if panel.scale == 'symlog' else None
        layout[f'xaxis{x[1:]}'] = _x_axis(panel)
        layout[f'yaxis{k}'] = _y_axis(panel, x, scale)
        for line in panel.lines:
            trace = _trace(line, panel, scale) | {'xaxis': x, 'yaxis': y}
            if figure.stacked:
                trace.setdefault('hovertemplate', f'%{{y:.8~g}} {_unit(panel)}')
            if time is None or not np.array_equal(line.x, time, equal_nan=True):
                trace['x'] = _rounded(line.x)
            trace['showlegend'] = panel.has_legend and line.name not in named
            if trace['showlegend']:
                named.add(line.name)
            plots['data'].append(trace)
        for place, text in panel.marks:
            layout['shapes'].append(_line((x, place, place), (f'{y} domain', 0, 1), 'faint'))
            if text:  # an annotation widens the range of the axis for its text
                at = math.log10(place) if panel.scale == 'log' else place
                note = _text(text, x, at, f'{y} domain', 0.99, ('right', 'top'))
                layout['annotations'].append(note | {'textangle': -90})
        colour = 'faint' if panel.lanes else 'fail'
        for level, text in panel.levels:
            height = float(scale.height(level)) if scale else level
            shape = _line((f'{x} domain', 0, 1), (y, height, height), colour, text)
            layout['shapes'].append(shape)
        if panel.title:
            title = _text(panel.title, f'{x} domain', 0.0, f'{y} domain', 1.0, ('left', 'bottom'))
            layout['annotations'].append(title)
    _place(layout, figure)
    if mechanism:
        turned = {'rotor': mechanism.rotor, 'output': mechanism.output}
        plots['turned'] = {name: _rounded(angle, '.3f') for name, angle in turned.items()}
        # motion.js moves this one, the last of the shapes.
        layout['shapes'].append(_line(('x', 0, 0), ('paper', 0, 1), 'text', dash='solid'))
    return plots


def _x_axis(panel: Panel) -> dict[str, Any]:
    kind = 'log' if panel.scale == 'log' else 'linear'
    axis: dict[str, Any] = {'title': {'text': escape(panel.x_label)}, 'type': kind}
    if panel.ticks:
        values, texts = zip(*panel.ticks, strict=True)
        axis |= {'tickvals': values, 'ticktext': [escape(text) for text in texts]}
        axis |= {'tickangle': -panel.tick_angle, 'range': list(panel.tick_range)}
        axis |= {'zeroline': False, 'automargin': 'height'}
    return axis


def _y_axis(panel: Panel, x: str, scale: SymmetricLog | None) -> dict[str, Any]:
    # The margin is narrow: the unit is below the name.
    axis: dict[str, Any] = {'title': {'text': escape(panel.y_label).replace(' [', '<br>[')}}
    axis |= scale.axis(panel) if scale else {'type': 'log' if panel.scale == 'log' else 'linear'}
    if panel.low is not None:
        top = max(float(np.nanmax(line.y)) for line in panel.lines)
        axis['range'] = [math.log10(panel.low), math.log10(2.0 * top)]
    if panel.equal:
        axis['scaleanchor'] = 'x' if x == 'x1' else x
    if panel.lanes:
        axis |= {'showticklabels': False, 'showgrid': False, 'zeroline': False}
        axis['range'] = list(panel.lane_range)
    return axis


def _place(layout: dict[str, Any], figure: Figure) -> None:
    """Place the axes of all panels."""
    if figure.stacked:
        heights = figure.heights
        ends = np.cumsum([0.0, *heights]) / (sum(heights) - _STACK_GAP)  # no gap below the last
        gap = _STACK_GAP / (sum(heights) - _STACK_GAP)
        for k, (start, end) in enumerate(pairwise(ends.tolist()), 1):
            layout[f'yaxis{k}']['domain'] = [max(0.0, 1.0 - end + gap), 1.0 - start]
        layout['xaxis']['anchor'] = f'y{len(heights)}'
        return
    rows, columns = figure.shape
    gap = _TICK_GAP if any(panel.tick_angle for panel in figure.panels) else _ROW_GAP
    width, height = (1.0 + _GAP) / columns, (1.0 + gap) / rows
    for k in range(len(figure.panels)):
        row, column = divmod(k, columns)
        left, top = column * width, 1.0 - row * height
        x, y = layout[f'xaxis{k + 1}'], layout[f'yaxis{k + 1}']
        x |= {'domain': [left, min(left + width - _GAP, 1.0)], 'anchor': f'y{k + 1}'}
        y |= {'domain': [max(0.0, top - height + gap), top], 'anchor': f'x{k + 1}'}


def _trace(line: Line, panel: Panel, scale: SymmetricLog | None) -> dict[str, Any]:
    trace: dict[str, Any] = {
        'name': line.name,
        'legendgroup': line.name,
        'meta': line.pen,
        'opacity': line.opacity,
        'y': _rounded(line.y),
    }
    if scale:
        trace['y'] = _rounded(scale.height(line.y), '.5g')
        trace['customdata'] = _rounded(line.y, '.4g')
        trace['hovertemplate'] = f'%{{customdata:.3g}} {_unit(panel)}'
    if line.error is not None:
        trace['error_y'] = {'type': 'data', 'array': _rounded(line.error, '.4g'), 'thickness': 1}
    if line.points:
        trace |= {'mode': 'markers', 'marker': {'size': 3 if len(line.x) > FEW else 8}}
    if line.pen == Pen.MODEL:
        trace['line'] = {'dash': 'dash'}
    if panel.lanes:  # an instant is a line without length
        trace |= {'mode': 'lines+markers', 'line': {'width': 4}, 'marker': {'size': 5}}
        trace['hovertemplate'] = f'{escape(line.name)}<extra></extra>'
    return trace


def _unit(panel: Panel) -> str:
    return panel.y_label.partition('[')[2].rstrip(']')


def _line(
    x: tuple[str, float, float],
    y: tuple[str, float, float],
    colour: str,
    text: str = '',
    dash: str = 'dash',
) -> dict[str, Any]:
    """Return a line between places on the axes, with a text below its start."""
    (xref, x0, x1), (yref, y0, y1) = x, y
    shape = {'type': 'line', 'xref': xref, 'yref': yref, 'x0': x0, 'x1': x1, 'y0': y0, 'y1': y1}
    shape |= {'meta': colour, 'line': {'dash': dash}}
    if text:  # inside the plot, where there is always room
        shape['label'] = {'text': escape(text), 'textposition': 'start', 'yanchor': 'top'}
    return shape


def _text(
    text: str, xref: str, x: float, yref: str, y: float, anchors: tuple[str, str]
) -> dict[str, Any]:
    place = {'text': escape(text), 'xref': xref, 'x': x, 'yref': yref, 'y': y}
    xanchor, yanchor = anchors
    return place | {'xanchor': xanchor, 'yanchor': yanchor, 'align': 'left', 'showarrow': False}


def _rounded(values: ArrayLike, digits: str = '.8g') -> list[float | None]:
    """Round to the digits that a plot can show; NaN and infinities become gaps."""
    return [
        float(format(value, digits)) if math.isfinite(value) else None
        for value in np.asarray(values).tolist()
    ]

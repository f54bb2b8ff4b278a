# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Converts panels for plotly, without colours, which page.js adds from the style sheet."""

import math
from collections.abc import Iterator, Sequence
from html import escape
from textwrap import wrap
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gear_kinematics.report.document import Line, Panel, Pen
from gear_kinematics.report.mechanism import MovingMechanism

_GAP = 0.2  # ratio of the gap between panels to the height of a panel with its gap
_LINE = 36  # greatest number of characters in a line of text, so that it fits on a phone


def interactive(panels: Sequence[Panel], mechanism: MovingMechanism | None) -> dict[str, Any]:
    """Return a plot of panels, from top to bottom, over a common x axis.

    It has `data` and `layout` of plotly, and `time`, the x of all lines that have no `x`. If a
    mechanism moves with the plot, `turned` has the angles of rotor and output, degrees, and
    `forces` the forces of its branches if these are drawn.
    """
    several = len(panels) > 1
    layout: dict[str, Any] = {'shapes': [], 'annotations': [], 'showlegend': False}
    layout['hovermode'] = 'x unified' if several else 'closest'
    x_label = {'text': _wrapped(panels[-1].x_label)}
    layout['xaxis'] = {'title': x_label, 'anchor': f'y{len(panels)}', 'constrain': 'domain'}
    time = mechanism.time if mechanism else panels[0].lines[0].x
    plot: dict[str, Any] = {'data': [], 'layout': layout, 'time': _rounded(time)}
    for k, (panel, domain) in enumerate(zip(panels, _domains(len(panels)), strict=True), 1):
        y = f'y{k}'
        layout[f'yaxis{k}'] = _y_axis(panel) | {'domain': domain}
        for line in panel.lines:
            trace = _trace(line) | {'xaxis': 'x', 'yaxis': y}
            if several:
                trace['hovertemplate'] = f'%{{y:.8~g}} {panel.unit}'
            if not np.array_equal(line.x, time, equal_nan=True):
                trace['x'] = _rounded(line.x)
            plot['data'].append(trace)
        for place, text in panel.marks:
            layout['shapes'].append(
                _line(('x', place, place), (f'{y} domain', 0, 1), 'faint', text)
            )
        for level, text in panel.levels:
            layout['shapes'].append(_line(('x domain', 0, 1), (y, level, level), 'fail', text))
        if several and panel.title:
            title = {'text': _wrapped(panel.title), 'align': 'left', 'showarrow': False}
            title |= {'xref': 'x domain', 'x': 0.0, 'xanchor': 'left'}
            title |= {'yref': f'{y} domain', 'y': 1.0, 'yanchor': 'bottom'}
            layout['annotations'].append(title)
    if mechanism:
        turned = {'rotor': mechanism.rotor, 'output': mechanism.output}
        plot['turned'] = {name: _rounded(angle, '.3f') for name, angle in turned.items()}
        if mechanism.forces is not None:
            plot['forces'] = [_rounded(force, '.3f') for force in mechanism.forces.T]
        # motion.js moves this shape, which must be the last.
        layout['shapes'].append(_line(('x', 0, 0), ('paper', 0, 1), 'text', dash='solid'))
    return plot


def _domains(count: int) -> Iterator[list[float]]:
    """Yield the ends of the y axes from top to bottom, relative to the height of the plot."""
    whole = count - _GAP  # no gap below the last
    for k in range(count):
        yield [max(0.0, (whole - k - 1 + _GAP) / whole), (whole - k) / whole]


def _y_axis(panel: Panel) -> dict[str, Any]:
    # The margin is narrow: the unit is below the name.
    axis: dict[str, Any] = {'title': {'text': escape(panel.y_label).replace(' [', '<br>[')}}
    axis['type'] = panel.scale
    if panel.equal:
        axis['scaleanchor'] = 'x'
    return axis


def _trace(line: Line) -> dict[str, Any]:
    trace: dict[str, Any] = {'name': line.name, 'meta': line.pen, 'y': _rounded(line.y)}
    if line.points:
        trace |= {'mode': 'markers', 'marker': {'size': 4}}
    if line.pen == Pen.MODEL:
        trace['line'] = {'dash': 'dash'}
    return trace


def _line(
    x: tuple[str, float, float],
    y: tuple[str, float, float],
    colour: str,
    text: str = '',
    dash: str = 'dash',
) -> dict[str, Any]:
    """Return a line between places on the axes, with a text beside it.

    The text is inside the plot, where there is always room: below the start, or left of the end.
    """
    (xref, x0, x1), (yref, y0, y1) = x, y
    shape = {'type': 'line', 'xref': xref, 'yref': yref, 'x0': x0, 'x1': x1, 'y0': y0, 'y1': y1}
    shape |= {'meta': colour, 'line': {'dash': dash}}
    if text:
        at_start = {'textposition': 'start', 'yanchor': 'top'}
        at_end = {'textposition': 'end', 'yanchor': 'bottom', 'xanchor': 'right', 'textangle': -90}
        shape['label'] = {'text': escape(text), **(at_end if x0 == x1 else at_start)}
    return shape


def _wrapped(text: str) -> str:
    return '<br>'.join(map(escape, wrap(text, _LINE)))


def _rounded(values: ArrayLike, digits: str = '.8g') -> list[float | None]:
    """Round to the digits that a plot can show; NaN and infinities become gaps."""
    return [
        float(format(value, digits)) if math.isfinite(value) else None
        for value in np.asarray(values).tolist()
    ]

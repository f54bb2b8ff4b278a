"""Converts figures for plotly, without colours, which page.js adds from the style sheet."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np

from gear_kinematics.report.document import (
    Array,
    Figure,
    Line,
    Panel,
    Pen,
    number,
)
from gear_kinematics.report.drawn import MovingMechanism

_GAP = 0.12
"""Gap between panels side by side / width of the figure."""
_STACK_GAP = 0.2
"""Gap between stacked panels / height of a panel with its gap."""
_ROW_GAP, _TICK_GAP = 0.2, 0.3
"""Gap between rows of panels / height of the figure, without and with upright texts of ticks."""
_TICK_ROOM = 50
"""Most characters of all ticks of a panel that find room in one line."""
_TICKS = 4
"""Most ticks on each side of zero."""
BEHIND = 0.5
"""Opacity of lines that stand behind others."""
FEW = 100
"""Most points that are drawn large."""
_SMALLEST = 1e-300
"""Smallest divisor without overflow."""


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
    layout: dict[str, Any] = {'shapes': [], 'annotations': [], **_legend(figure)}
    plots: dict[str, Any] = {'data': [], 'layout': layout}
    time = None
    if figure.stacked:
        time = mechanism.time if mechanism else panels[0].lines[0].x
        plots['time'] = _rounded(time)
    else:
        layout['hovermode'] = 'closest'
    named: set[str] = set()
    for k, panel in enumerate(panels, 1):
        x = 'x' if figure.stacked else f'x{k}'
        scale = SymmetricLog.of(panel) if panel.scale == 'symlog' else None
        layout |= _axes(figure, panel, k, scale)
        for line in panel.lines:
            trace = _stacked(line, panel, scale) if figure.stacked else _aside(line, x)
            if time is not None and not np.array_equal(line.x, time, equal_nan=True):
                trace['x'] = _rounded(line.x)
            trace['yaxis'] = f'y{k}'
            shown = is_named(panel) and line.name not in named
            trace |= {'legendgroup': line.name, 'showlegend': shown}
            plots['data'].append(_styled(trace, line, panel))
            if shown:
                named.add(line.name)
        layout['shapes'] += [_mark(place, x, k) for place, _ in panel.marks]
        layout['shapes'] += [
            _level(scale(y) if scale else y, text, x, k, 'faint' if panel.lanes else 'fail')
            for y, text in panel.levels
        ]
        layout['annotations'] += [
            _note(math.log10(place) if panel.scale == 'log' else place, text, x, k)
            for place, text in panel.marks
            if text
        ]
        if panel.title:
            layout['annotations'].append(_title(panel.title, x, k))
    if mechanism:
        turned = {'rotor': mechanism.rotor, 'output': mechanism.output}
        plots['turned'] = {name: _thousandths(angle) for name, angle in turned.items()}
        # motion.js moves this one, the last of the shapes.
        cursor = _line('x', (0, 0), 'paper', (0, 1), meta='text', line={'dash': 'solid'})
        layout['shapes'].append(cursor)
    return plots


def _legend(figure: Figure) -> dict[str, Any]:
    """Return the place of the legend, above all curves and beside the buttons on the right."""
    several = any(map(is_named, figure.panels))
    place = {'xref': 'container', 'x': 0.0, 'xanchor': 'left'}
    place |= {'yref': 'container', 'y': 1.0, 'yanchor': 'top'}
    return {'showlegend': several, 'legend': {'orientation': 'h', **place}}


def is_named(panel: Panel) -> bool:
    """Return whether the legend names the lines; where there is only one, the axis does."""
    return not panel.lanes and len({line.name for line in panel.lines}) > 1


def _axes(
    figure: Figure, panel: Panel, k: int, scale: 'SymmetricLog | None'
) -> dict[str, dict[str, Any]]:
    """Return the axes of the k-th panel by their names."""
    count = len(figure.panels)
    kind = 'log' if panel.scale == 'log' else 'linear'
    x: dict[str, Any] = {'title': {'text': escape(panel.x_label)}, 'type': kind}
    # The margin is narrow: the unit is below the name.
    y: dict[str, Any] = {'title': {'text': escape(panel.y_label).replace(' [', '<br>[')}}
    if scale:
        y |= scale.axis(panel)
    else:
        y['type'] = kind
    if panel.low is not None:
        top = max(float(np.nanmax(line.y)) for line in panel.lines)
        y['range'] = [math.log10(panel.low), math.log10(2.0 * top)]
    if panel.equal:
        y['scaleanchor'] = 'x' if k == 1 else f'x{k}'
    if panel.lanes:
        y |= {'showticklabels': False, 'showgrid': False, 'zeroline': False}
        y['range'] = list(lane_range(panel))
    if panel.ticks:
        values, texts = zip(*panel.ticks, strict=True)
        x |= {'tickvals': values, 'ticktext': [escape(text) for text in texts]}
        x |= {'tickangle': -tick_angle(panel), 'range': tick_range(panel), 'zeroline': False}
        x['automargin'] = 'height'
    if figure.stacked:
        heights = figure.heights
        whole = sum(heights) - _STACK_GAP  # there is no gap below the last one
        top = 1.0 - sum(heights[: k - 1]) / whole
        bottom = top - (heights[k - 1] - _STACK_GAP) / whole
        return {
            'xaxis': x | {'anchor': f'y{count}'},
            f'yaxis{k}': y | {'domain': [max(0.0, bottom), top]},
        }
    rows, columns = figure.shape
    row, column = divmod(k - 1, columns)
    gap = _TICK_GAP if any(map(tick_angle, figure.panels)) else _ROW_GAP
    width, height = (1.0 + _GAP) / columns, (1.0 + gap) / rows
    left, top = column * width, 1.0 - row * height
    across = [left, min(left + width - _GAP, 1.0)]
    y['domain'] = [max(0.0, top - height + gap), top]
    return {
        f'xaxis{k}': x | {'domain': across, 'anchor': f'y{k}'},
        f'yaxis{k}': y | {'anchor': f'x{k}'},
    }


def tick_range(panel: Panel) -> tuple[float, float]:
    """Ends of an x axis with ticks, so that there is room for their texts."""
    return panel.ticks[0][0] - 0.5, panel.ticks[-1][0] + 0.5


def lane_range(panel: Panel) -> tuple[float, float]:
    """Ends of the y axis of lanes, so that the name of each has room below it."""
    return -len(panel.lines) - 0.1, 0.6


def tick_angle(panel: Panel) -> float:
    """Degrees by which the texts of ticks are turned, to find room side by side."""
    return 90.0 if sum(len(text) for _, text in panel.ticks) > _TICK_ROOM else 0.0


def _stacked(line: Line, panel: Panel, scale: 'SymmetricLog | None') -> dict[str, Any]:
    if panel.lanes:
        return {'y': _rounded(line.y), 'hovertemplate': f'{escape(line.name)}<extra></extra>'}
    unit = panel.y_label.partition('[')[2].rstrip(']')
    if not scale:
        return {'y': _rounded(line.y), 'hovertemplate': f'%{{y:.8~g}} {unit}'}
    return {
        'y': _rounded([scale(value) for value in line.y.tolist()], 5),
        'customdata': _rounded(line.y, 4),
        'hovertemplate': f'%{{customdata:.3g}} {unit}',
    }


def _aside(line: Line, x: str) -> dict[str, Any]:
    return {'x': _rounded(line.x, 6), 'y': _rounded(line.y, 6), 'xaxis': x}


def _styled(trace: dict[str, Any], line: Line, panel: Panel) -> dict[str, Any]:
    trace |= {'name': line.name, 'meta': line.pen}
    if line.error is not None:
        trace['error_y'] = {'type': 'data', 'array': _rounded(line.error, 4), 'thickness': 1}
    if line.behind:
        trace['opacity'] = BEHIND
    if line.points:
        trace |= {'mode': 'markers', 'marker': {'size': 3 if len(line.x) > FEW else 8}}
    if line.pen == Pen.MODEL:
        trace['line'] = {'dash': 'dash'}
    if panel.lanes:  # an instant is a line without length
        trace |= {'mode': 'lines+markers', 'line': {'width': 4}, 'marker': {'size': 5}}
    return trace


@dataclass(frozen=True, slots=True)
class SymmetricLog:
    """A scale that is logarithmic on both sides of zero, and linear near zero."""

    smallest: float
    """The power of ten at which the logarithmic part starts."""
    greatest: float

    @classmethod
    def of(cls, panel: Panel) -> 'SymmetricLog':
        """Choose the scale for all values and levels of a panel."""
        values = [value for line in panel.lines for value in line.y.tolist()]
        finite = [value for value in values if math.isfinite(value)]
        return cls.fit([*finite, *(level for level, _ in panel.levels)])

    @classmethod
    def fit(cls, values: Sequence[float]) -> 'SymmetricLog':
        """Choose the scale that shows all magnitudes within twelve decades."""
        magnitudes = [abs(value) for value in values if value]
        greatest = max(max(magnitudes, default=1.0), _SMALLEST)
        least = max(min(magnitudes, default=1.0), 1e-12 * greatest, _SMALLEST)
        # At least one decade, even for a single magnitude.
        return cls(10.0 ** (_decade(least) - (_decade(least) == _decade(greatest))), greatest)

    def __call__(self, value: float) -> float:
        """Return the height of a value."""
        return math.copysign(math.log10(1.0 + abs(value) / self.smallest), value)

    def ticks(self) -> list[float]:
        """Return powers of ten up to the greatest value, at even distances."""
        lowest, highest = _decade(self.smallest), _decade(self.greatest)
        step = max(1, math.ceil((highest - lowest) / _TICKS))
        return [10.0**decade for decade in range(highest, lowest, -step)]

    def axis(self, panel: Panel) -> dict[str, Any]:
        """Return the range and the ticks of the axis of a panel."""
        negative = any(np.nanmin(line.y, initial=0.0) < 0.0 for line in panel.lines)
        signs = (-1, 1) if negative else (1,)
        ticks = sorted({0.0, *(sign * tick for sign in signs for tick in self.ticks())})
        reach = 1.1 * self(self.greatest)
        return {
            'tickvals': [self(tick) for tick in ticks],
            'ticktext': [number(tick) for tick in ticks],
            'range': [-reach if negative else -0.1 * reach, reach],
        }


def _decade(value: float) -> int:
    # From the text, as the logarithm of 1e-9 may be slightly less than -9.
    return int(f'{value:e}'.partition('e')[2])


def _mark(place: float, x: str, k: int) -> dict[str, Any]:
    return _line(x, (place, place), f'y{k} domain', (0, 1), meta='faint')


def _level(height: float, text: str, x: str, k: int, colour: str) -> dict[str, Any]:
    # Inside the plot, where there is always room.
    label = {'text': escape(text), 'textposition': 'start', 'yanchor': 'top'}
    return _line(f'{x} domain', (0, 1), f'y{k}', (height, height), label=label, meta=colour)


def _line(
    xref: str, x: tuple[float, float], yref: str, y: tuple[float, float], **others: Any
) -> dict[str, Any]:
    ends = {'x0': x[0], 'x1': x[1], 'y0': y[0], 'y1': y[1]}
    return {'type': 'line', 'xref': xref, 'yref': yref, **ends, **others}


def _note(place: float, text: str, x: str, k: int) -> dict[str, Any]:
    """Return the text at a mark, along its line."""
    return _text(text, x, place, k, 0.99, ('right', 'top')) | {'textangle': -90}


def _title(text: str, x: str, k: int) -> dict[str, Any]:
    return _text(text, f'{x} domain', 0.0, k, 1.0, ('left', 'bottom'))


def _text(
    text: str, xref: str, x: float, k: int, y: float, anchors: tuple[str, str]
) -> dict[str, Any]:
    place = {'xref': xref, 'x': x, 'yref': f'y{k} domain', 'y': y}
    xanchor, yanchor = anchors
    alignment = {'xanchor': xanchor, 'yanchor': yanchor, 'align': 'left', 'showarrow': False}
    return {'text': escape(text), **place, **alignment}


def _rounded(values: Array | Sequence[float], digits: int = 8) -> list[float | None]:
    """Round to the digits that a plot can show; NaN and infinities become gaps."""
    return [
        float(f'{value:.{digits}g}') if math.isfinite(value) else None
        for value in np.asarray(values).tolist()
    ]


def _thousandths(values: Array) -> list[float | None]:
    return [round(value, 3) if math.isfinite(value) else None for value in values.tolist()]

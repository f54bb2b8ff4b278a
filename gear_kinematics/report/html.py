"""The report as one page, which needs neither network nor server."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

from gear_kinematics.report import wording
from gear_kinematics.report.motion import Drawings, turned
from gear_kinematics.report.page import definitions, page, table
from gear_kinematics.report.page import figure as write_figure
from gear_kinematics.report.wording import OUTCOME
from gear_kinematics.validation.report import BagReport, Series, Verdict

_GAP = 0.05
"""Between two plots, of the figure's height."""
_TICKS = 4
"""At most, to each side of zero."""
_LEAST = 1e-300
"""Next to it are numbers that nothing can be divided by."""
_CURSOR = {
    'type': 'line',
    'meta': 'text',
    'line': {'dash': 'solid'},
    'x0': 0,
    'x1': 0,
    'yref': 'paper',
    'y0': 0,
    'y1': 1,
}
"""The last of the shapes, which motion.js moves."""


def to_html(reports: Sequence[BagReport]) -> str:
    """Write the reports as a page that holds all it needs, plotly.js included.

    Raises:
        ModuleNotFoundError: if there is something to plot, and plotly is not installed.
    """
    title = f'{OUTCOME[wording.worst_verdict(reports)]}: {_title(reports)}'
    scripts = ['page.js', 'motion.js'] if any(map(_plotted, reports)) else []
    return page(title, ''.join(_body(reports)), scripts=scripts)


# Page


def _title(reports: Sequence[BagReport]) -> str:
    return wording.bag_name(reports[0]) if len(reports) == 1 else wording.totals(reports)


def _body(reports: Sequence[BagReport]) -> Iterator[str]:
    verdict = wording.worst_verdict(reports)
    yield f'<header><h1>{_badge(verdict)} gearkin validate</h1>'
    yield f'<p>{escape(wording.totals(reports))}</p></header>\n<main>\n'
    if len(reports) > 1:
        links = [f'#bag-{k}' for k in range(len(reports))]
        yield f'<section id="top">{table(wording.summary_table(reports), links)}</section>\n'
    drawings = Drawings()
    for k, report in enumerate(reports):
        yield f'<section id="bag-{k}">\n'
        yield from _section(report, f'figure-{k}', drawings)
        if len(reports) > 1:
            yield '<p><a href="#top">to the summary</a></p>\n'
        yield '</section>\n'
    yield f'</main>\n{drawings.shapes()}'


def _section(report: BagReport, name: str, drawings: Drawings) -> Iterator[str]:
    yield f'<h2>{_badge(report.verdict)} {escape(wording.bag_name(report))}</h2>\n'
    yield definitions(wording.head(report))
    remarks = wording.remarks(report)
    if remarks:
        items = ''.join(f'<li>{escape(remark)}</li>' for remark in remarks)
        yield f'<ul class="remarks {report.verdict}">{items}</ul>\n'
    for make_table in (wording.topic_table, wording.field_table, wording.worst_table):
        yield table(make_table(report))
    if report.rotor:
        yield definitions(wording.rotor_table(report.rotor))
    yield table(wording.gap_table(report))
    if _plotted(report):
        plots = figure(report)
        yield '<h3>Mechanism, angles and errors over time</h3>\n<div class="moving">\n'
        if report.mechanism and report.series:
            yield from drawings.moving(report.mechanism, report.module, name, report.series)
        yield from write_figure(name, plots)
        yield '</div>\n'


def _badge(verdict: Verdict) -> str:
    return f'<span class="badge {verdict}">{OUTCOME[verdict]}</span>'


# Plots


def _plotted(report: BagReport) -> bool:
    return report.series is not None and bool(report.series.time)


def figure(report: BagReport) -> dict[str, Any]:
    """Describe the plots for plotly: angles and errors above one another, over the same time."""
    series = report.series or Series([], [], [], [], [])
    rows = [
        _angle_row('rotor angle', series.rotor_angle),
        _angle_row('output angle', series.output_angle),
        _error_row('angle error', 'rad', series.angle_error, _tolerance(report, 'rad')),
        _error_row('position error', 'm', series.position_error, _tolerance(report, 'm')),
    ]
    height = (1 + _GAP) / len(rows)
    layout: dict[str, Any] = {
        'xaxis': {'title': {'text': 'time [s]'}, 'anchor': f'y{len(rows)}'},
        'shapes': [],
    }
    for k, row in enumerate(rows):
        top = 1 - k * height
        domain = [max(0.0, top - height + _GAP), top]
        layout[f'yaxis{k + 1}'] = {**row.axis, 'domain': domain}
        row.trace['yaxis'] = f'y{k + 1}'
        layout['shapes'] += [_level(level, f'y{k + 1}') for level in row.tolerances]
    plots: dict[str, Any] = {
        'time': [_rounded(value) for value in series.time],
        'data': [row.trace for row in rows],
        'layout': layout,
    }
    if report.mechanism:
        plots['turned'] = turned(report.mechanism, series.rotor_angle)
        layout['shapes'].append(_CURSOR)
    return plots


@dataclass(frozen=True, slots=True)
class _Row:
    """One of the plots above one another."""

    trace: dict[str, Any]
    axis: dict[str, Any]
    tolerances: tuple[float, ...] = ()


def _angle_row(name: str, values: Sequence[float]) -> _Row:
    trace = {
        'name': name,
        'meta': 'angle',
        'y': [_rounded(value) for value in values],
        'hovertemplate': '%{y:.6f} rad',
    }
    return _Row(trace, {'title': {'text': f'{name}<br>[rad]'}})


def _error_row(name: str, unit: str, values: Sequence[float], tolerance: float) -> _Row:
    """Scale errors by their logarithm, with their sign, and with a place for zero."""
    finite = [value for value in values if math.isfinite(value)]
    scale = SymmetricLog.fit([*finite, tolerance])
    signs = (-1, 1) if any(value < 0 for value in finite) else (1,)
    ticks = sorted({0.0, *(sign * tick for sign in signs for tick in scale.ticks())})
    reach = 1.1 * scale(scale.greatest)
    trace = {
        'name': name,
        'meta': 'error',
        'y': [_rounded(scale(value), 5) for value in values],
        'customdata': [_rounded(value, 4) for value in values],
        'hovertemplate': f'%{{customdata:.3g}} {unit}',
    }
    axis = {
        'title': {'text': f'{name}<br>[{unit}]'},
        'tickvals': [scale(tick) for tick in ticks],
        'ticktext': [wording.number(tick) for tick in ticks],
        'range': [-reach if -1 in signs else -0.1 * reach, reach],
    }
    levels = tuple(sign * scale(tolerance) for sign in signs) if tolerance else ()
    return _Row(trace, axis, levels)


@dataclass(frozen=True, slots=True)
class SymmetricLog:
    """A scale that is logarithmic to both sides of zero, and linear next to it."""

    smallest: float
    """The power of ten from which on it is logarithmic."""
    greatest: float

    @classmethod
    def fit(cls, values: Sequence[float]) -> 'SymmetricLog':
        """Choose the scale on which all values can be told apart, within twelve decades."""
        magnitudes = [abs(value) for value in values if value]
        greatest = max(max(magnitudes, default=1.0), _LEAST)
        least = max(min(magnitudes, default=1.0), 1e-12 * greatest, _LEAST)
        # With a decade to show where only one magnitude is there.
        return cls(10.0 ** (_decade(least) - (_decade(least) == _decade(greatest))), greatest)

    def __call__(self, value: float) -> float:
        """Give the height of a value."""
        return math.copysign(math.log10(1.0 + abs(value) / self.smallest), value)

    def ticks(self) -> list[float]:
        """Give powers of ten up to the greatest value, at even distances."""
        lowest, highest = _decade(self.smallest), _decade(self.greatest)
        step = max(1, math.ceil((highest - lowest) / _TICKS))
        return [10.0**decade for decade in range(highest, lowest, -step)]


def _decade(value: float) -> int:
    # As written, for 1e-9 may have a logarithm of slightly less than -9.
    return int(f'{value:e}'.partition('e')[2])


def _tolerance(report: BagReport, unit: str) -> float:
    """Give the tolerance in a unit, 0 where nothing was compared in it."""
    fields = (field for topic in report.topics for field in topic.fields)
    return next((field.tolerance for field in fields if field.unit == unit), 0.0)


def _level(height: float, axis: str) -> dict[str, Any]:
    return {
        'type': 'line',
        'xref': 'paper',
        'x0': 0,
        'x1': 1,
        'yref': axis,
        'y0': height,
        'y1': height,
        # Once, and inside, where the plot always has room.
        'label': {
            'text': 'tolerance' if height > 0 else '',
            'textposition': 'start',
            'yanchor': 'top',
        },
    }


def _rounded(value: float, digits: int = 8) -> float | None:
    """Drop the digits that no plot shows; what is no number leaves a hole in the line."""
    return float(f'{value:.{digits}g}') if math.isfinite(value) else None

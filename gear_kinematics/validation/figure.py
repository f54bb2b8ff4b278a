"""The curves of a validation, and the mechanism that moves with them."""

from collections.abc import Iterator, Sequence

import numpy as np

from gear_kinematics.kinematics import Mechanism, solve, split_turns
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.report.document import (
    Array,
    Figure,
    Line,
    Panel,
    Pen,
    printable,
)
from gear_kinematics.report.drawn import DrawnBranch, DrawnMechanism, MovingMechanism
from gear_kinematics.shape.outlines import NAMES, bodies
from gear_kinematics.validation.report import (
    BagReport,
    Curve,
    FieldReport,
    Lane,
    Series,
    TopicReport,
)
from gear_kinematics.validation.wording import field_name, seconds

_TIME = 'time [s]'
_MARGIN = 0.02
"""How far marks may lie outside of the curves / their length."""


def figure(report: BagReport) -> Figure | None:
    """Return the panels of a bag over time, with what failed first; None if there is nothing."""
    curves = list(_curves(report))
    if not curves and not report.lanes:
        return None
    failed = [found for found in curves if not found[1].passed]
    passed = [found for found in curves if found[1].passed]
    panels = [panel for found in (*failed, *passed[:1]) for panel in _both(*found)]
    if report.lanes:
        place = 0 if not failed and any(lane.fails for lane in report.lanes) else 2
        panels.insert(place, _lanes(report.lanes, curves[0][2].time if curves else ()))
    panels += [_error(*found) for found in passed[1:] if not failed and found[1].unit == 'm']
    panels += [_rotor(report.series[0])] if curves else []
    return Figure(tuple(panels), stacked=True)


def _curves(report: BagReport) -> Iterator[tuple[TopicReport, FieldReport, Series, Curve]]:
    """Yield each field that was compared, with its curve."""
    for topic in report.topics:
        for series in report.series:
            for field in topic.fields:
                for curve in series.curves:
                    if (series.topic, curve.field) == (topic.topic, field.name) and series.time:
                        yield topic, field, series, curve


def _both(
    topic: TopicReport, field: FieldReport, series: Series, curve: Curve
) -> tuple[Panel, Panel]:
    """Return the panels of a field: recorded over expected, and below it the error."""
    time = np.asarray(series.time, np.float64)
    lines = (
        Line('expected', Pen.MODEL, time, np.asarray(curve.expected, np.float64)),
        Line('recorded', Pen.FIRST, time, np.asarray(curve.recorded, np.float64)),
    )
    name = field_name(topic, field)
    title = f'{name}: {printable(curve.part)}' if curve.part else name
    values = Panel(title, _TIME, _label(field.name, field.unit), lines)
    return values, _error(topic, field, series, curve, title='')


def _error(
    topic: TopicReport,
    field: FieldReport,
    series: Series,
    curve: Curve,
    title: str | None = None,
) -> Panel:
    errors = np.asarray(curve.error, np.float64)
    line = Line('error', Pen.SECOND, np.asarray(series.time, np.float64), errors)
    levels = []
    if field.tolerance:
        levels.append((field.tolerance, 'tolerance'))
        if (errors < 0.0).any():
            levels.append((-field.tolerance, ''))
    return Panel(
        field_name(topic, field) if title is None else title,
        _TIME,
        _label('error', field.unit),
        (line,),
        levels=tuple(levels),
        scale='symlog',
    )


def _label(name: str, unit: str) -> str:
    return printable(f'{name} [{unit}]')


def _rotor(series: Series) -> Panel:
    time, angle = (np.asarray(v, np.float64) for v in (series.time, series.rotor_angle))
    return Panel('', _TIME, 'rotor angle [rad]', (Line('rotor angle', Pen.FAINT, time, angle),))


def _lanes(lanes: Sequence[Lane], time: Sequence[float]) -> Panel:
    """Return a panel with a lane for all that happened; its marks are near times, if there are."""
    first, last = np.fmin.reduce(time, initial=np.inf), np.fmax.reduce(time, initial=-np.inf)
    if first > last:
        first, last = -np.inf, np.inf
    margin = _MARGIN * (last - first)
    lines, levels = [], []
    for k, lane in enumerate(lanes):
        name = printable(f'{lane.topic} {lane.event}')
        spans = np.clip(np.reshape(lane.spans, (-1, 2)), first - margin, last + margin)
        # A gap in the line after each span.
        x = np.insert(spans, 2, np.nan, axis=1).ravel()
        lines.append(
            Line(name, Pen.FIFTH if lane.fails else Pen.SECOND, x, np.full(len(x), -float(k)))
        )
        levels.append((-float(k), f'{name}: {lane.count}'))
    return Panel('', _TIME, '', tuple(lines), levels=tuple(levels), lanes=True)


def moving(report: BagReport) -> MovingMechanism | None:
    """Return the mechanism at the worst moment; None of a gear without bodies."""
    mechanism = report.mechanism
    if not (mechanism and report.series and report.series[0].time):
        return None
    angles = np.asarray(report.series[0].rotor_angle, np.float64)
    turns, angle = split_turns(angles)
    state = solve(mechanism, angles)
    output_turns = np.round((state.output_angle - state.output_turn_angle) / TURN)
    time = np.asarray(report.series[0].time, np.float64)
    worst = _worst_moment(report)
    return MovingMechanism(
        drawn(mechanism, report.module),
        time,
        _degrees(turns, angle),
        _degrees(output_turns, state.output_turn_angle),
        0 if worst is None else int(np.argmin(np.nan_to_num(np.abs(time - worst), nan=np.inf))),
    )


def drawn(mechanism: Mechanism, module: float) -> DrawnMechanism:
    """Return what a mechanism looks like; the module of its teeth is in m."""
    return DrawnMechanism(
        tuple(
            DrawnBranch(branch.name, branch.cam_phase, bodies(mechanism, module, k))
            for k, branch in enumerate(mechanism.branches)
        ),
        NAMES,
        mechanism.eccentricity,
    )


def _worst_moment(report: BagReport) -> float | None:
    """When the first field that failed was worst, or else something first happened, s."""
    for topic in report.topics:
        for field in topic.fields:
            stamps = (field.first_non_finite, field.first_absent, field.worst_stamp)
            if not field.passed and (known := [s for s in stamps if s is not None]):
                return seconds(known[-1], report)
    return next((lane.spans[0][0] for lane in report.lanes if lane.fails), None)


def _degrees(turns: Array, angle: Array) -> Array:
    """Return angles in degrees, minus the whole turns of the first sample."""
    with np.errstate(invalid='ignore'):  # infinite turns
        degrees: Array = 360.0 * (turns - turns[0]) + np.degrees(angle)
    return degrees

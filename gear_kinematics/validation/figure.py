# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The curves of a validation, and the mechanism that moves with them."""

from collections.abc import Sequence
from itertools import chain
from typing import NamedTuple

import numpy as np

from gear_kinematics.kinematics import solve, split_turns
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.report.document import Array, Figure, Line, Panel, Pen, printable
from gear_kinematics.report.mechanism import MovingMechanism
from gear_kinematics.validation.findings import field_name
from gear_kinematics.validation.report import BagReport, Curve, FieldReport, Lane

_TIME = 'time [s]'
_MARGIN = 0.02
"""How far marks may lie outside of the curves / their length."""


class _Compared(NamedTuple):
    """A field that was compared, with its curve."""

    name: str
    field: FieldReport
    time: Sequence[float]
    curve: Curve

    def value_panel(self) -> Panel:
        """Draw what was recorded over what was expected."""
        lines = (
            _line(self.time, 'expected', Pen.MODEL, self.curve.expected),
            _line(self.time, 'recorded', Pen.FIRST, self.curve.recorded),
        )
        title = f'{self.name}: {printable(self.curve.part)}' if self.curve.part else self.name
        return Panel(title, _TIME, printable(f'{self.field.name} [{self.field.unit}]'), lines)

    def error_panel(self, title: str = '') -> Panel:
        """Draw the error within its tolerance."""
        line, levels = _line(self.time, 'error', Pen.SECOND, self.curve.error), []
        if tolerance := self.field.tolerance:
            levels = [(tolerance, 'tolerance'), (-tolerance, '')]
        shown = tuple(levels if (line.y < 0.0).any() else levels[:1])
        label = printable(f'error [{self.field.unit}]')
        return Panel(title, _TIME, label, (line,), levels=shown, scale='symlog')


def figure(report: BagReport) -> Figure | None:
    """Return the panels of a bag over time, with what failed first; None if there is nothing."""
    series = {one.topic: one for one in report.series if one.time}
    compared = [
        _Compared(field_name(topic, field), field, series[topic.topic].time, curve)
        for topic in report.topics
        if topic.topic in series
        for field in topic.fields
        for curve in series[topic.topic].curves
        if curve.field == field.name
    ]
    if not compared and not report.lanes:
        return None
    failed = [one for one in compared if not one.field.passed]
    passed = [one for one in compared if one.field.passed]
    shown = ((one.value_panel(), one.error_panel()) for one in (*failed, *passed[:1]))
    panels = list(chain.from_iterable(shown))
    if report.lanes:
        place = 0 if not failed and any(lane.fails for lane in report.lanes) else 2
        panels.insert(place, _lanes(report.lanes, compared[0].time if compared else ()))
    if not failed:
        panels += [one.error_panel(one.name) for one in passed[1:] if one.field.unit == 'm']
    if compared:
        first = report.series[0]
        line = _line(first.time, 'rotor angle', Pen.FAINT, first.rotor_angle)
        panels.append(Panel('', _TIME, 'rotor angle [rad]', (line,)))
    return Figure(tuple(panels), stacked=True)


def _line(time: Sequence[float], name: str, pen: Pen, values: Sequence[float]) -> Line:
    return Line(name, pen, np.asarray(time, float), np.asarray(values, float))


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
        pen = Pen.FIFTH if lane.fails else Pen.SECOND
        lines.append(Line(name, pen, x, np.full(len(x), -float(k))))
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
        mechanism,
        report.module,
        time,
        _degrees(turns, angle),
        _degrees(output_turns, state.output_turn_angle),
        0 if worst is None else int(np.argmin(np.nan_to_num(np.abs(time - worst), nan=np.inf))),
    )


def _worst_moment(report: BagReport) -> float | None:
    """When the first field that failed was worst, or else something first happened, s."""
    for topic in report.topics:
        for field in topic.fields:
            worst = field.worst_stamp if field.is_beyond else None
            stamps = (worst, field.first_non_finite, field.first_absent)
            if not field.passed and (known := [s for s in stamps if s is not None]):
                return report.seconds(known[0])
    return next((lane.spans[0][0] for lane in report.lanes if lane.fails), None)


def _degrees(turns: Array, angle: Array) -> Array:
    """Return angles in degrees, minus the whole turns of the first sample."""
    with np.errstate(invalid='ignore'):  # infinite turns
        degrees: Array = 360.0 * (turns - turns[0]) + np.degrees(angle)
    return degrees

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The errors of a validation over time, and the mechanism that moves with them."""

from collections.abc import Sequence

import numpy as np

from gear_kinematics.kinematics import solve, split_turns
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.report.document import Array, Figure, Line, Panel, Pen, printable
from gear_kinematics.report.mechanism import MovingMechanism
from gear_kinematics.validation.findings import field_name, findings
from gear_kinematics.validation.report import BagReport, FieldReport, Series

_TIME = 'time [s]'


def figure(report: BagReport) -> Figure | None:
    """Return the errors of what failed over time, or else of the first field; None of nothing."""
    series = {one.topic: one for one in report.series if one.time}
    compared = [
        (field, _error_panel(field_name(topic, field), field, found))
        for topic in report.topics
        if (found := series.get(topic.topic))
        for field in topic.fields
        if field.name in found.errors
    ]
    if not compared:
        return None
    panels = [panel for field, panel in compared if not field.passed] or [compared[0][1]]
    first = report.series[0]
    line = _line(first.time, 'rotor angle', Pen.FAINT, first.rotor_angle)
    return Figure((*panels, Panel('', _TIME, 'rotor angle [rad]', (line,))), stacked=True)


def _error_panel(title: str, field: FieldReport, series: Series) -> Panel:
    """Draw an error within its tolerance."""
    line, levels = _line(series.time, 'error', Pen.SECOND, series.errors[field.name]), []
    if tolerance := field.tolerance:
        levels = [(tolerance, 'tolerance'), (-tolerance, '')]
    shown = tuple(levels if (line.y < 0.0).any() else levels[:1])
    label = printable(f'error [{field.unit}]')
    return Panel(title, _TIME, label, (line,), levels=shown, scale='symlog')


def _line(time: Sequence[float], name: str, pen: Pen, values: Sequence[float]) -> Line:
    return Line(name, pen, np.asarray(time, float), np.asarray(values, float))


def moving(report: BagReport) -> MovingMechanism | None:
    """Return the mechanism at the moment of the gravest finding; None of a gear without bodies."""
    mechanism = report.mechanism
    if not (mechanism and report.series and report.series[0].time):
        return None
    angles = np.asarray(report.series[0].rotor_angle, np.float64)
    turns, angle = split_turns(angles)
    state = solve(mechanism, angles)
    output_turns = np.round((state.output_angle - state.output_turn_angle) / TURN)
    time = np.asarray(report.series[0].time, np.float64)
    worst = next((found.time for found in findings(report) if found.time is not None), time[0])
    return MovingMechanism(
        mechanism,
        report.module,
        time,
        _degrees(turns, angle),
        _degrees(output_turns, state.output_turn_angle),
        int(np.argmin(np.nan_to_num(np.abs(time - worst), nan=np.inf))),
    )


def _degrees(turns: Array, angle: Array) -> Array:
    """Return angles in degrees, minus the whole turns of the first sample."""
    with np.errstate(invalid='ignore'):  # infinite turns
        degrees: Array = 360.0 * (turns - turns[0]) + np.degrees(angle)
    return degrees

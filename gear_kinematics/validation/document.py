"""A validation as a document."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from gear_kinematics.kinematics import Mechanism, solve, split_turns
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.report.document import (
    OUTCOME,
    Array,
    Case,
    Document,
    DrawnBranch,
    Figure,
    Line,
    MovingMechanism,
    Panel,
    Pen,
    Section,
    Verdict,
    printable,
)
from gear_kinematics.shape.outlines import NAMES, bodies
from gear_kinematics.validation.report import BagReport, Series
from gear_kinematics.validation.tables import bag_name, summary, tables
from gear_kinematics.validation.wording import (
    counted,
    field_faults,
    field_name,
    findings,
    topic_faults,
)

SCHEMA = 'gear_kinematics/report'
VERSION = 1


def document(reports: Sequence[BagReport]) -> Document:
    """Return the document of a validation, with a section for each bag."""
    count = {verdict: sum(report.verdict == verdict for report in reports) for verdict in Verdict}
    counts = ', '.join(f'{count[verdict]} {OUTCOME[verdict]}' for verdict in Verdict)
    # No bags at all count as unusable.
    verdict = next((v for v in reversed(Verdict) if count[v]), Verdict.UNUSABLE)
    return Document(
        'gearkin validate',
        tuple(map(_section, reports)),
        {
            'schema': SCHEMA,
            'version': VERSION,
            'verdict': verdict,
            'bags': [_bag(report) for report in reports],
        },
        verdict,
        summary(reports),
        f'{counted(len(reports), "bag")}: {counts}',
    )


def _section(report: BagReport) -> Section:
    series = report.series if report.series and report.series.time else None
    mechanism = report.mechanism
    return Section(
        bag_name(report),
        tables(report),
        report.verdict,
        tuple(findings(report)),
        figure=_figure(report, series) if series else None,
        mechanism=_moving(mechanism, report.module, series) if mechanism and series else None,
        cases=tuple(_cases(report)),
    )


def _bag(report: BagReport) -> dict[str, Any]:
    """Return the JSON content about a bag; docs/report.schema.json describes it."""
    content = asdict(report)
    for drawn in ('series', 'mechanism', 'module'):
        del content[drawn]
    for topic, written in zip(report.topics, content['topics'], strict=True):
        written['passed'] = topic.passed
        for field, values in zip(topic.fields, written['fields'], strict=True):
            values |= {'passed': field.passed, 'budget_used': field.budget_used}
    return content


# Test cases


def _cases(report: BagReport) -> Iterator[Case]:
    parts = list(_parts(report))
    if report.verdict == Verdict.UNUSABLE:
        # Even without an error, the suite must not look as if it passed.
        yield Case('bag', (printable(report.error or 'the bag is unusable'),), 'error')
    elif report.verdict == Verdict.FAIL and not any(part.faults for part in parts):
        faults = tuple(finding.text for finding in findings(report))
        yield Case('bag', faults or ('the bag fails',))
    else:
        yield Case('bag')
    yield from parts


def _parts(report: BagReport) -> Iterator[Case]:
    if report.rotor:
        # Never fails by itself: its faults appear as wrong or missing outputs.
        yield Case(printable(f'input {report.rotor.topic}'))
    for topic in report.topics:
        yield Case(printable(topic.topic), tuple(topic_faults(topic, report)))
        for field in topic.fields:
            yield Case(field_name(topic, field), tuple(field_faults(field, report)))


# Figure


def _figure(report: BagReport, series: Series) -> Figure:
    """Return angles and errors, stacked over time."""
    panels = [
        _panel('rotor angle', 'rad', series.time, series.rotor_angle),
        _panel('output angle', 'rad', series.time, series.output_angle),
    ]
    errors_of = [('angle error', 'rad', series.angle_error)]
    if report.mechanism:
        errors_of.append(('position error', 'm', series.position_error))
    for name, unit, errors in errors_of:
        panels.append(
            _panel(name, unit, series.time, errors, tuple(_tolerances(report, unit, errors)))
        )
    return Figure(tuple(panels), stacked=True)


def _panel(
    name: str,
    unit: str,
    time: Sequence[float],
    values: Sequence[float],
    levels: tuple[tuple[float, str], ...] | None = None,
) -> Panel:
    pen = Pen.FIRST if levels is None else Pen.SECOND
    line = Line(name, pen, np.asarray(time), np.asarray(values))
    panel = Panel('', 'time [s]', f'{name} [{unit}]', (line,))
    return panel if levels is None else replace(panel, levels=levels, scale='symlog')


def _tolerances(
    report: BagReport, unit: str, errors: Sequence[float]
) -> Iterator[tuple[float, str]]:
    """Yield the tolerance in a unit on the sides of zero that have errors, if there is one."""
    fields = (field for topic in report.topics for field in topic.fields)
    tolerance = next((field.tolerance for field in fields if field.unit == unit), 0.0)
    if tolerance:
        yield tolerance, 'tolerance'
        if any(error < 0.0 for error in errors):
            yield -tolerance, ''


def _moving(mechanism: Mechanism, module: float, series: Series) -> MovingMechanism:
    angles = np.asarray(series.rotor_angle, np.float64)
    turns, angle = split_turns(angles)
    state = solve(mechanism, angles)
    output_turns = np.round((state.output_angle - state.output_turn_angle) / TURN)
    return MovingMechanism(
        tuple(
            DrawnBranch(branch.name, branch.cam_phase, bodies(mechanism, module, k))
            for k, branch in enumerate(mechanism.branches)
        ),
        NAMES,
        mechanism.eccentricity,
        np.asarray(series.time, np.float64),
        _degrees(turns, angle),
        _degrees(output_turns, state.output_turn_angle),
    )


def _degrees(turns: Array, angle: Array) -> Array:
    """Return angles in degrees, minus the whole turns of the first sample."""
    with np.errstate(invalid='ignore'):  # infinite turns
        degrees: Array = 360.0 * (turns - turns[0]) + np.degrees(angle)
    return degrees

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A validation as a document: its tables, its figure and its test cases."""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gear_kinematics.kinematics import solve, split_turns
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.report import document as doc
from gear_kinematics.report.document import OUTCOME, counted, number, printable, worst
from gear_kinematics.report.mechanism import MovingMechanism
from gear_kinematics.validation.findings import (
    answer,
    faults,
    field_name,
    findings,
    sentence,
    worst_field,
)
from gear_kinematics.validation.report import (
    BagReport,
    FieldReport,
    InputReport,
    Series,
    TopicReport,
)

_SCHEMA = 'gear_kinematics/report'
_VERSION = 1
_TIME = 'time [s]'
_LEAST_ERROR = 1e-18  # error, in any unit, as which smaller errors and zeros are drawn

Row = tuple[doc.Cell, ...]


def document(reports: Sequence[BagReport]) -> doc.Document:
    """Return the document of a validation, with a section for each bag and each actuator."""
    parts = [part for report in reports for part in (report, *report.actuators)]
    count = Counter(report.verdict for report in reports)
    counts = ', '.join(f'{count[verdict]} {OUTCOME[verdict]}' for verdict in doc.Verdict)
    columns = 'bag', 'verdict', 'compared', 'largest error', 'tolerance', 'first finding'
    return doc.Document(
        'gearkin validate',
        tuple(map(_section, parts)),
        {
            'schema': _SCHEMA,
            'version': _VERSION,
            'verdict': worst(report.verdict for report in reports),
            'bags': [_bag(report) for report in reports],
        },
        doc.Table(columns, tuple(map(_summary, parts)), words=('', 'verdict', 'first finding')),
        f'{counted(len(reports), "bag")}: {counts}' if len(reports) != 1 else '',
    )


def _name(report: BagReport) -> str:
    bag = printable(report.bag) or '(no name)'
    return f'{bag}: {report.actuator}' if report.actuator else bag


def _section(report: BagReport) -> doc.Section:
    drawn = figure(report)
    return doc.Section(
        _name(report),
        tuple(_tables(report)),
        report.verdict,
        tuple(findings(report)),
        figure=drawn,
        mechanism=moving(report) if drawn else None,
        cases=tuple(_cases(report)),
        answer=answer(report),
        elapsed=report.elapsed,
    )


def _bag(report: BagReport) -> dict[str, Any]:
    """Return the JSON content about a bag; docs/report.schema.json describes it."""
    content = asdict(replace(report, series=(), mechanism=None, actuators=()))
    for left_out in ('series', 'mechanism', 'module', 'elapsed', 'actuators'):
        del content[left_out]
    if report.actuators:
        content['actuators'] = [_bag(each) for each in report.actuators]
    if not report.actuator:
        del content['actuator']
    content['findings'] = [one.text for one in findings(report) if one.kind == 'finding']
    content['causes'] = [sentence(finding, report) for finding in report.causes]
    for topic, written in zip(report.topics, content['topics'], strict=True):
        written['faults'] = [sentence(fault, report) for fault in topic.faults]
        written['passed'] = topic.passed
        for field, values in zip(topic.fields, written['fields'], strict=True):
            values |= {'passed': field.passed, 'budget_used': field.budget_used}
    return content


def _cases(report: BagReport) -> Iterator[doc.Case]:
    """Yield the test cases of JUnit: the bag, its input, and each topic and field."""
    # Even without a finding, an unusable bag must not look as if it had passed.
    texts = tuple(one.text for one in findings(report)) or (f'the bag {OUTCOME[report.verdict]}',)
    unusable = report.verdict == doc.Verdict.UNUSABLE
    yield doc.Case('bag', () if report.passed else texts, 'error' if unusable else 'failure')
    if report.rotor:
        # Never fails by itself: its faults appear as wrong or missing outputs.
        yield doc.Case(printable(f'input {report.rotor.topic}'))
    for topic in report.topics:
        for name in (topic.topic, *(field_name(topic, field) for field in topic.fields)):
            at_fault = (sentence(one, report) for one in faults(report) if one.topic == name)
            yield doc.Case(printable(name), tuple(at_fault))


def _tables(report: BagReport) -> Iterator[doc.Table]:
    """Yield the tables about a bag; the first describes the reference of the comparison."""
    yield doc.Table.of_values(
        doc.Layout.INLINE,
        ('config', printable(report.config)),
        ('gear ratio', printable(report.gear_ratio)),
        ('messages', str(report.messages)),
    )
    if report.rotor:
        yield _input_table(report.rotor)
    yield doc.Table.of_items(TOPIC, report.topics)
    fields = (_field(field_name(t, field), field) for t in report.topics for field in t.fields)
    yield doc.Table(_FIELDS, tuple(fields))


def _summary(report: BagReport) -> Row:
    """Summarise what was compared in a bag, and its first finding."""
    field = worst_field(report)
    error, tolerance = (field.max_error, field.tolerance) if field else (None, None)
    unit = printable(field.unit) if field else ''
    return (
        doc.Cell(_name(report)),
        doc.Cell(OUTCOME[report.verdict], doc.Tone.PLAIN if report.passed else doc.Tone.BAD),
        doc.Cell(str(sum(topic.compared for topic in report.every_topic))),
        _measured(error, unit),
        _measured(tolerance, unit),
        doc.Cell('' if report.passed else next((found.text for found in findings(report)), '')),
    )


def _input_table(rotor: InputReport) -> doc.Table:
    rejected = {f'rejected, {printable(cause)}': n for cause, n in sorted(rotor.rejected.items())}
    counts = {'rejected': sum(rotor.rejected.values()), **rejected, 'gaps': rotor.gaps}
    return doc.Table.of_values(
        doc.Layout.INLINE,
        ('joint', printable(rotor.joint)),
        ('messages', str(rotor.messages)),
        ('valid', str(rotor.valid)),
        *((name, _count(count, doc.Tone.NOTABLE)) for name, count in counts.items()),
        ('rate', _measured(rotor.rate, 'Hz', digits=6)),
        ('duration', _measured(rotor.duration, 's', digits=6)),
        ('max speed', _measured(rotor.max_speed, 'rad/s', digits=6)),
        about=('input', printable(rotor.topic)),
    )


TOPIC: Mapping[str, Callable[[TopicReport], str | doc.Cell]] = {
    'topic': lambda topic: printable(topic.topic),
    'messages': lambda topic: str(topic.messages),
    'compared': lambda topic: doc.Cell(
        str(topic.compared), *[doc.Tone.BAD] * (not topic.compared)
    ),
    'missing': lambda topic: _count(topic.missing),
    'extra': lambda topic: _count(topic.extra),
    'out of order': lambda topic: _count(topic.out_of_order),
    'left out': lambda topic: doc.Cell(str(sum(topic.left_out.values()) or ''), doc.Tone.NOTABLE),
}
"""The columns about a topic."""
_FIELDS = 'field', 'compared', 'absent', 'not finite', 'max error', 'tolerance', 'rms error'


def _field(name: str, field: FieldReport) -> Row:
    unit = printable(field.unit)
    errors = (field.max_error, field.tolerance, field.rms_error) if field.compared else [None] * 3
    greatest, *others = (_measured(error, unit) for error in errors)
    return (
        doc.Cell(name, unit=unit),
        doc.Cell(str(field.compared)),
        _count(field.absent),
        _count(field.non_finite),
        doc.Cell(greatest.text, doc.Tone.BAD if field.is_beyond else doc.Tone.PLAIN, unit),
        *others,
    )


def _measured(value: float | None, unit: str, digits: int = 3) -> doc.Cell:
    return doc.Cell('' if value is None else number(value, digits), unit=unit)


def _count(count: int, tone: doc.Tone = doc.Tone.BAD) -> doc.Cell:
    return doc.Cell(str(count), tone if count else doc.Tone.NONE)


def figure(report: BagReport) -> doc.Figure | None:
    """Plot over time the errors of what failed, or else of the first field; None without any."""
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
    line = _line(first.time, 'rotor angle', doc.Pen.FAINT, first.rotor_angle)
    return doc.Figure((*panels, doc.Panel('', _TIME, 'rotor angle [rad]', (line,))), stacked=True)


def _error_panel(title: str, field: FieldReport, series: Series) -> doc.Panel:
    error = np.abs(np.asarray(series.errors[field.name], float))
    # A logarithmic axis has no zero.
    line = _line(series.time, 'error', doc.Pen.SECOND, np.maximum(error, _LEAST_ERROR))
    levels = ((field.tolerance, 'tolerance'),) if field.tolerance else ()
    label = printable(f'error [{field.unit}]')
    return doc.Panel(title, _TIME, label, (line,), levels=levels, scale='log')


def _line(time: Sequence[float], name: str, pen: doc.Pen, values: ArrayLike) -> doc.Line:
    return doc.Line(name, pen, np.asarray(time, float), np.asarray(values, float))


def moving(report: BagReport) -> MovingMechanism | None:
    """Return the mechanism at the moment of the gravest finding; None if it is unknown."""
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


def _degrees(turns: doc.Array, angle: doc.Array) -> doc.Array:
    """Return angles in degrees, minus the whole turns of the first sample."""
    with np.errstate(invalid='ignore'):  # infinite turns
        degrees: doc.Array = 360.0 * (turns - turns[0]) + np.degrees(angle)
    return degrees

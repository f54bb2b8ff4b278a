# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The report on lost motion: tables, plots, and the JSON, which docs/lost_motion.md describes."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from gear_kinematics.measurement.answer import Limits, answer, remarks
from gear_kinematics.measurement.figures import LOST_MOTION_SHARE, GearFigures
from gear_kinematics.measurement.loops import Ramps
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.measured import LOST_MOTION, Measured, cell_of
from gear_kinematics.measurement.transmission import TransmissionFigures
from gear_kinematics.measurement.wording import ARC_MINUTES
from gear_kinematics.report import document as doc
from gear_kinematics.report.document import MOST_POINTS, counted, number, printable
from gear_kinematics.report.json import estimated
from gear_kinematics.statistics.uncertainty import COVERAGE, Estimate

SCHEMA = 'gear_kinematics/lost_motion'
VERSION = 3
_COLUMNS = 2  # panels side by side
_DIRECTIONS: tuple[tuple[int, str, doc.Pen], ...] = (
    (0, 'turning back', doc.Pen.FAINT),
    (1, 'forward', doc.Pen.FIRST),
    (-1, 'backward', doc.Pen.SECOND),
)
_HALVES = {True: ('torque rising', doc.Pen.FIRST), False: ('torque falling', doc.Pen.SECOND)}


@dataclass(frozen=True, eq=False, slots=True)
class Comparison:
    """Comparison of recordings at a common torque."""

    section: doc.Section
    sentence: str  # the answer, in one line
    data: Mapping[str, Any]  # for the JSON


def document(
    reports: Sequence[LostMotion], comparison: Comparison | None, limits: Limits
) -> doc.Document:
    """Return the document on recordings, with a section for each, and then their comparison."""
    sections, recordings = zip(*(_reported(report, limits) for report in reports), strict=True)
    mains = [{'recording': printable(report.name), **_main(report)} for report in reports]
    rows = (tuple(map(doc.Cell, main.values())) for main in mains)
    return doc.Document(
        'gearkin lost-motion',
        (*sections, *([comparison.section] if comparison else [])),
        {
            'schema': SCHEMA,
            'version': VERSION,
            'coverage': COVERAGE,
            'recordings': recordings,
            **(comparison.data if comparison else {}),
        },
        doc.Table(tuple(mains[0]), tuple(rows)),
        comparison.sentence if comparison else '',
    )


def _reported(report: LostMotion, limits: Limits) -> tuple[doc.Section, Mapping[str, Any]]:
    """Return the section on a recording, and its part of the JSON."""
    recording, both = report.recording, report.recording.encoders
    said, checks = answer(report).sentence, [*limits.judge(report)]
    notes = [*recording.sentences, *(found.sentence for found in remarks(report))]
    remarked = tuple(map(printable, notes))
    failed_first = sorted(checks, key=lambda check: check.holds)
    verdict = doc.Verdict.PASS if all(check.holds for check in checks) else doc.Verdict.FAIL
    judged = [check.why.sentence for check in failed_first]
    findings = [*judged, said]
    if report.wrong_ratio:  # by which all other figures are wrong
        verdict, findings = doc.Verdict.UNUSABLE, [said, *judged]
    faults = (() if check.holds else (str(check.why),) for check in checks)
    cases = (doc.Case(check.limit, own) for check, own in zip(checks, faults, strict=True))
    section = doc.Section(
        printable(report.name),
        tuple(_tables(report)),
        verdict if checks or report.wrong_ratio else None,
        tuple(doc.Sentence('finding', text) for text in findings),
        remarked,
        doc.Figure(tuple(_panels(report)), columns=_COLUMNS),
        key=doc.Table.of_values(doc.Layout.INLINE, *_main(report).items()),
        cases=tuple(cases) or (doc.Case('measured', (said,) if report.wrong_ratio else ()),),
    )
    data = {
        'recording': report.name,
        'answer': said,
        'limits': {
            check.limit: {'holds': check.holds, 'text': str(check.why)} for check in checks
        },
        'columns': recording.columns,
        'samples': recording.rows,
        'error': recording.damage,
        'gear_ratio': str(report.gear_ratio),
        **(_of_gear(report.figures) if report.figures else {}),
        'measured': report.measured,
        'transmission': report.transmission,
        'delay_unit': ('s' if both.timed else 'rows') if both else None,
        'remarks': remarked,
    }
    return section, data


def _main(report: LostMotion) -> dict[str, str]:
    return {f'{f.name} [{cell_of(f.unit).unit}]': f.cell.text for f in report.main_figures}


# Tables


def _tables(report: LostMotion) -> Iterator[doc.Table]:
    found, motion, both = report.figures, report.transmission, report.recording.encoders
    yield doc.Table.of_values(
        doc.Layout.INLINE,
        ('samples', str(report.recording.rows)),
        ('columns', printable('; '.join(report.recording.columns))),
        ('gear ratio', str(report.gear_ratio)),
        ('rated torque', f'{number(found.rated_torque)} N·m' if found else ''),
        ('ramps', '; '.join(map(_ramps, found.ramps)) if found else ''),
        ('travel', f'{number(math.degrees(motion.travel), 4)}°' if motion else ''),
    )
    if found:
        yield _table(found.listed())
    if motion:
        unit = 's' if both and both.timed else 'rows'
        errors = (
            Measured('transmission accuracy', 'rad', motion.forward, ' forward'),
            Measured('transmission accuracy', 'rad', motion.backward, ' backward'),
            Measured('backward minus forward', 'rad', motion.reversals),
            Measured(LOST_MOTION, 'rad', motion.lost_motion, ' on reversals'),
            Measured('delay of the output encoder', unit, motion.delay),
        )
        yield _table(errors)


def _ramps(ramps: Ramps) -> str:
    return f'{counted(len(ramps.loops), "loop")} to {number(ramps.amplitude)} N·m'


def _table(figures: Iterable[Measured]) -> doc.Table:
    """Return a row for each known figure; one whose ± exceeds it stands out."""
    known = [figure for figure in figures if figure.value]
    rows = ((doc.Cell(f'{own.name}{own.at}', unit=own.cell.unit), own.cell) for own in known)
    return doc.Table(('figure', 'value'), tuple(rows))


def _panels(report: LostMotion) -> Iterator[doc.Panel]:
    if found := report.figures:
        torque = LOST_MOTION_SHARE * found.rated_torque
        yield from (_ramp_panel(ramps, torque) for ramps in found.ramps)
    if motion := report.transmission:
        yield _error_panel(motion)


def _ramp_panel(ramps: Ramps, at: float) -> doc.Panel:
    centre = float(np.mean([loop.middle(0.0) for loop in ramps.loops]))
    lines = []
    for half in (half for loop in ramps.loops for half in reversed(loop)):
        # A ramp may continue to a larger amplitude, which has its own panel.
        inside = np.flatnonzero(np.abs(half.torque) <= 1.02 * ramps.amplitude)
        rows = inside[:: math.ceil(len(inside) / MOST_POINTS)]
        name, pen = _HALVES[half.rising]
        angle = (half.angle[rows] - centre) * ARC_MINUTES
        lines.append(doc.Line(name, pen, half.torque[rows], angle))
    for line in ramps.lines:
        angle = (line.angle - centre) * ARC_MINUTES
        lines.append(doc.Line('middle line: without friction', doc.Pen.MODEL, line.load, angle))
    return doc.Panel(
        f'ramps to {number(ramps.amplitude)} N·m',
        f'torque at the output [N·m]; dashed: 0 and ±{100.0 * LOST_MOTION_SHARE:g} % of rated',
        'wind-up at the output [arcmin]',
        tuple(lines),
        marks=((-at, ''), (0.0, ''), (at, '')),
    )


def _error_panel(motion: TransmissionFigures) -> doc.Panel:
    lines = []
    for sign, name, pen in _DIRECTIONS:
        rows = motion.direction == sign
        if rows.any():
            error = (motion.error[rows] - motion.offset) * ARC_MINUTES
            angle = np.degrees(motion.angle[rows])
            lines.append(doc.Line.reduced(name, pen, angle, error, points=sign == 0))
    title, label = 'transmission error less its mean', 'measured less ideal [arcmin]'
    return doc.Panel(title, 'output angle [°]', label, tuple(lines))


def _of_gear(found: GearFigures) -> dict[str, Any]:
    return {
        'rated_torque': found.rated_torque,
        'ramps': [
            {
                'amplitude': own.amplitude,
                'loops': len(own.loops),
                'hysteresis': _with_unit(width, 'rad'),
            }
            for own, width in zip(found.ramps, found.widths, strict=True)
        ],
        'hysteresis': _with_unit(found.hysteresis, 'rad'),
        'lost_motion': _with_unit(found.lost_motion, 'rad'),
        'friction': _with_unit(found.friction, 'N·m'),
        'middle_line': {
            name: getattr(found.middle_line, name).tolist()
            for name in ('angle', 'load', 'friction')
        },
        'backlash': {
            **_with_unit(found.backlash.value, 'rad'),
            'low': found.backlash.low,
            'high': found.backlash.high,
            'cause': found.backlash.cause.value or None,
        },
        'stiffness': [
            {'low': own.low, 'high': own.high, **_with_unit(own.slope, 'N·m/rad')}
            for own in found.stiffness
        ],
        'overall_stiffness': _with_unit(found.overall, 'N·m/rad'),
    }


def _with_unit(estimate: Estimate | None, unit: str) -> dict[str, Any]:
    unknown = {'value': None, 'expanded_uncertainty': None}
    return {'unit': unit, **(estimated(estimate) if estimate else unknown)}

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The report on lost motion: tables, and the JSON, which docs/lost_motion.md describes."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from gear_kinematics.measurement.answer import LimitCheck, Limits, answer, remarks
from gear_kinematics.measurement.curves import panels
from gear_kinematics.measurement.figures import GearFigures
from gear_kinematics.measurement.json_values import plain
from gear_kinematics.measurement.loops import Ramps
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.measured import LOST_MOTION, Measured, shown
from gear_kinematics.report.document import (
    Case,
    Cell,
    Document,
    Figure,
    Layout,
    Section,
    Sentence,
    Table,
    Verdict,
    counted,
    number,
    printable,
)
from gear_kinematics.statistics.uncertainty import COVERAGE, Estimate

SCHEMA = 'gear_kinematics/lost_motion'
VERSION = 3
_COLUMNS = 2  # panels side by side


@dataclass(frozen=True, eq=False, slots=True)
class Comparison:
    """Comparison of recordings at a common torque."""

    section: Section
    sentence: str  # the answer, in one line
    data: Mapping[str, Any]  # for the JSON


def document(
    reports: Sequence[LostMotion], comparison: Comparison | None, limits: Limits
) -> Document:
    """Return the document on recordings, with a section for each, and then their comparison."""
    sections, recordings = [], []
    for report in reports:
        notes = [*report.recording.sentences, *(found.sentence for found in remarks(report))]
        sentences = answer(report).sentence, [*limits.judge(report)], tuple(map(printable, notes))
        sections.append(_section(report, *sentences))
        recordings.append(_recording(report, *sentences))
    verdicts = [section.verdict for section in sections if section.verdict]
    return Document(
        'gearkin lost-motion',
        (*sections, *([comparison.section] if comparison else [])),
        {
            'schema': SCHEMA,
            'version': VERSION,
            'coverage': COVERAGE,
            'recordings': recordings,
            **(comparison.data if comparison else {}),
        },
        max(verdicts, key=list(Verdict).index, default=None),
        _summary(reports),
        comparison.sentence if comparison else '',
    )


def _section(
    report: LostMotion, said: str, judged: Sequence[LimitCheck], remarked: tuple[str, ...]
) -> Section:
    passed = all(judgement.holds for judgement in judged)
    return Section(
        printable(report.name),
        tuple(_tables(report)),
        (Verdict.PASS if passed else Verdict.FAIL) if judged else None,
        (
            *(
                Sentence('finding', one.why.sentence)
                for one in sorted(judged, key=lambda one: one.holds)
            ),
            Sentence('finding', said),
        ),
        remarked,
        Figure(tuple(panels(report)), columns=_COLUMNS),
        key=Table.of_values(Layout.INLINE, *_main(report).items()),
        cases=tuple(Case(one.limit, () if one.holds else (str(one.why),)) for one in judged)
        or (Case('measured'),),
    )


def _summary(reports: Sequence[LostMotion]) -> Table:
    mains = [(printable(report.name), _main(report)) for report in reports]
    rows = ((Cell(name), *map(Cell, main.values())) for name, main in mains)
    return Table(('recording', *mains[0][1]), tuple(rows))


def _main(report: LostMotion) -> dict[str, str]:
    return {f'{f.name} [{shown(f.unit).unit}]': f.cell.text for f in report.main_figures}


# Tables


def _tables(report: LostMotion) -> Iterator[Table]:
    found, motion, both = report.figures, report.transmission, report.recording.encoders
    yield Table.of_values(
        Layout.INLINE,
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


def _table(figures: Iterable[Measured]) -> Table:
    """A row for each figure that is known; one that its ± exceeds stands out."""
    known = [figure for figure in figures if figure.value]
    rows = ((Cell(f'{own.name}{own.at}', unit=own.cell.unit), own.cell) for own in known)
    return Table(('figure', 'value'), tuple(rows))


# JSON


def _recording(
    report: LostMotion, said: str, judged: Sequence[LimitCheck], remarked: tuple[str, ...]
) -> Mapping[str, Any]:
    recording, both = report.recording, report.recording.encoders
    return {
        'recording': report.name,
        'answer': said,
        'limits': {one.limit: {'holds': one.holds, 'text': str(one.why)} for one in judged},
        'columns': recording.columns,
        'samples': recording.rows,
        'error': recording.damage,
        'gear_ratio': str(report.gear_ratio),
        **(_of_gear(report.figures) if report.figures else {}),
        'measured': report.measured,
        'transmission': plain(report.transmission),
        'delay_unit': ('s' if both.timed else 'rows') if both else None,
        'remarks': remarked,
    }


def _of_gear(found: GearFigures) -> dict[str, Any]:
    return {
        'rated_torque': found.rated_torque,
        'ramps': [{'amplitude': own.amplitude, 'loops': len(own.loops)} for own in found.ramps],
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
    return {'unit': unit, **(plain(estimate) or unknown)}

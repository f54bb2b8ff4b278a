# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The report on lost motion: tables, and the JSON, which docs/lost_motion.md describes."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from gear_kinematics.correction.uncertainty import COVERAGE, Estimate
from gear_kinematics.measurement.answer import Judgement, Limits, answer, remarks
from gear_kinematics.measurement.curves import panels
from gear_kinematics.measurement.figures import Figures, GearFigures, Stiffness
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.measured import Measured, shown
from gear_kinematics.measurement.middle_line import Backlash
from gear_kinematics.measurement.transmission import TransmissionFigures
from gear_kinematics.measurement.wording import arc_minutes, plain
from gear_kinematics.report.document import (
    Case,
    Cell,
    Document,
    Figure,
    Finding,
    Layout,
    Section,
    Table,
    Verdict,
    counted,
    number,
    printable,
)

SCHEMA = 'gear_kinematics/lost_motion'
VERSION = 2
_COLUMNS = 2
"""Panels side by side."""


@dataclass(frozen=True, eq=False, slots=True)
class Comparison:
    """Of recordings at a common torque."""

    section: Section
    sentence: str
    """The answer, in one line."""
    data: Mapping[str, Any]
    """For the JSON, without its dataclasses converted."""


def document(
    reports: Sequence[LostMotion], comparisons: Sequence[Comparison], limits: Limits
) -> Document:
    """Return the document on recordings, with a section for each, and then their comparisons."""
    sections, recordings = [], []
    for report in reports:
        sentences = answer(report), limits.judge(report), remarks(report)
        sections.append(_section(report, *sentences))
        recordings.append(_recording(report, *sentences))
    verdicts = [section.verdict for section in sections if section.verdict]
    return Document(
        'gearkin lost-motion',
        (*sections, *(replace(found.section, leads=True) for found in comparisons)),
        {
            'schema': SCHEMA,
            'version': VERSION,
            'coverage': COVERAGE,
            'recordings': recordings,
            **{key: plain(value) for found in comparisons for key, value in found.data.items()},
        },
        max(verdicts, key=list(Verdict).index, default=None),
        _summary(reports),
        '; '.join(found.sentence for found in comparisons),
    )


def _section(
    report: LostMotion, said: str, judged: Sequence[Judgement], remarked: Sequence[str]
) -> Section:
    passed = all(judgement.holds for judgement in judged)
    return Section(
        printable(report.name),
        tuple(_tables(report)),
        (Verdict.PASS if passed else Verdict.FAIL) if judged else None,
        (
            *(Finding('finding', f'{one.text[0].upper()}{one.text[1:]}.') for one in judged),
            Finding('finding', said),
        ),
        tuple(remarked),
        Figure(tuple(panels(report)), columns=_COLUMNS),
        key=Table.of_values(Layout.INLINE, *_main(report).items()),
        cases=tuple(Case(one.limit, () if one.holds else (one.text,)) for one in judged)
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
    ramps = found.by_amplitude if found else ()
    yield Table.of_values(
        Layout.INLINE,
        ('samples', str(report.recording.rows)),
        ('columns', printable('; '.join(report.recording.columns))),
        ('gear ratio', str(report.gear_ratio)),
        ('rated torque', f'{number(found.settings.rated_torque)} N·m' if found else ''),
        ('ramps', '; '.join(map(_ramps, ramps))),
        ('travel', f'{number(math.degrees(motion.travel), 4)}°' if motion else ''),
    )
    if found:
        several = ramps if len(ramps) > 1 else ()
        sources = {f'to {number(own.ramps.amplitude)} N·m': own.listed() for own in several}
        yield _table({'value': found.listed(), **sources})
    if motion:
        errors = (
            Measured('transmission accuracy', 'rad', motion.forward, ' forward'),
            Measured('transmission accuracy', 'rad', motion.backward, ' backward'),
            Measured('backward minus forward', 'rad', motion.reversals),
            Measured('lost motion', 'rad', motion.lost_motion, ' on reversals'),
            Measured(
                'delay of the output encoder', 's' if both and both.timed else 'rows', motion.delay
            ),
        )
        yield _table({'value': errors})
        yield _order_table(motion)


def _ramps(figures: Figures) -> str:
    ramps = figures.ramps
    rate = f' at {number(ramps.rate)} N·m/s' if ramps.rate else ''
    return f'{counted(len(ramps.loops), "loop")} to {number(ramps.amplitude)} N·m{rate}'


def _table(columns: Mapping[str, Iterable[Measured]]) -> Table:
    """A row for each figure, and a column for each source; what its ± exceeds stands out."""
    cells = [
        {f'{figure.name}{figure.at}': figure.cell for figure in figures if figure.value}
        for figures in columns.values()
    ]
    subjects = {label: Cell(label, unit=cell.unit) for own in cells for label, cell in own.items()}
    rows = (
        (subject, *(own.get(label, Cell('')) for own in cells))
        for label, subject in subjects.items()
    )
    return Table(('figure', *columns), tuple(rows))


def _order_table(found: TransmissionFigures) -> Table:
    """Return the amplitudes of the marked orders."""
    return Table.of_items(
        {
            'order': lambda order: order.name,
            'cycles per output turn': lambda order: str(order.cycles),
            'forward [′]': lambda order: arc_minutes(order.forward),
            'backward [′]': lambda order: arc_minutes(order.backward),
        },
        [order for order in found.orders if order.forward or order.backward],
    )


# JSON


def _recording(
    report: LostMotion, said: str, judged: Sequence[Judgement], remarked: Sequence[str]
) -> Mapping[str, Any]:
    recording, both = report.recording, report.recording.encoders
    return {
        'recording': report.name,
        'answer': said,
        'limits': {one.limit: {'holds': one.holds, 'text': one.text} for one in judged},
        'columns': recording.columns,
        'samples': recording.rows,
        'error': recording.damage,
        'gear_ratio': str(report.gear_ratio),
        **(_of_gear(report.figures) if report.figures else {}),
        'measured': report.measured,
        'transmission': plain(report.transmission),
        'encoders': both
        and {
            'delay_unit': 's' if both.timed else 'rows',
            'rotor_step': both.rotor_step_at_output(report.gear_ratio).size,
            'rotor_step_source': both.rotor_step.source,
            'output_step': both.output_step.size,
            'output_step_source': both.output_step.source,
            'unmatched': both.unmatched,
        },
        'remarks': remarked,
    }


def _of_gear(found: GearFigures) -> dict[str, Any]:
    figures = _figures(found)
    figures['lost_motion_without_friction']['load'] = found.settings.small_load
    return {
        'rated_torque': found.settings.rated_torque,
        **figures,
        'overall_stiffness': _stiffness(found.overall) if found.overall else None,
        'by_amplitude': [
            {
                'amplitude': own.ramps.amplitude,
                'loops': len(own.ramps.loops),
                'rate': own.ramps.rate,
                **_figures(own),
            }
            for own in found.by_amplitude
        ],
    }


def _figures(found: GearFigures | Figures) -> dict[str, Any]:
    return {
        'hysteresis': _with_unit(found.hysteresis, 'rad'),
        'lost_motion': _with_unit(found.lost_motion, 'rad'),
        'lost_motion_without_friction': _with_unit(found.frictionless, 'rad'),
        'friction': _with_unit(found.friction, 'N·m'),
        'backlash': _backlash(found.backlash),
        'stiffness': [_stiffness(stiffness) for stiffness in found.stiffness],
    }


def _with_unit(estimate: Estimate | None, unit: str) -> dict[str, Any]:
    unknown = {'value': None, 'expanded_uncertainty': None}
    return {'unit': unit, **(plain(estimate) or unknown)}


def _stiffness(stiffness: Stiffness) -> dict[str, Any]:
    return {
        'low': stiffness.low,
        'high': stiffness.high,
        **_with_unit(stiffness.both, 'N·m/rad'),
        'positive': plain(stiffness.positive),
        'negative': plain(stiffness.negative),
    }


def _backlash(backlash: Backlash | None) -> dict[str, Any] | None:
    return backlash and {
        **_with_unit(backlash.value, 'rad'),
        'low': backlash.low,
        'high': backlash.high,
        'cause': backlash.cause.value or None,
    }

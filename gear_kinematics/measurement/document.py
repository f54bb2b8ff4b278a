"""The report on lost motion as a document; docs/lost_motion.md describes its JSON."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from gear_kinematics.correction.uncertainty import COVERAGE, Estimate
from gear_kinematics.measurement.answer import answer, remarks
from gear_kinematics.measurement.comparison import Comparison
from gear_kinematics.measurement.curves import panels
from gear_kinematics.measurement.figures import GearFigures, Stiffness
from gear_kinematics.measurement.limits import Limits
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.middle_line import Backlash
from gear_kinematics.measurement.tables import head, key, summary, tables
from gear_kinematics.measurement.wording import plain
from gear_kinematics.report.document import (
    Case,
    Document,
    Figure,
    Finding,
    Section,
    Verdict,
    printable,
)

SCHEMA = 'gear_kinematics/lost_motion'
VERSION = 2
_COLUMNS = 2
"""Panels side by side."""


def document(
    reports: Sequence[LostMotion], comparisons: Sequence[Comparison], limits: Limits
) -> Document:
    """Return the document on recordings, with a section for each, and then their comparisons."""
    sections = tuple(_section(report, limits) for report in reports)
    verdicts = [section.verdict for section in sections if section.verdict]
    return Document(
        'gearkin lost-motion',
        (*sections, *(replace(found.section, leads=True) for found in comparisons)),
        {
            'schema': SCHEMA,
            'version': VERSION,
            'coverage': COVERAGE,
            'recordings': [_recording(report, limits) for report in reports],
            **{key: plain(value) for found in comparisons for key, value in found.data.items()},
        },
        max(verdicts, key=list(Verdict).index, default=None),
        summary(reports),
        '; '.join(found.sentence for found in comparisons),
    )


def _section(report: LostMotion, limits: Limits) -> Section:
    judged = list(limits.judge(report))
    passed = all(judgement.holds for judgement in judged)
    return Section(
        printable(report.name),
        (head(report), *tables(report)),
        (Verdict.PASS if passed else Verdict.FAIL) if judged else None,
        (
            *(Finding('finding', f'{one.text[0].upper()}{one.text[1:]}.') for one in judged),
            Finding('finding', answer(report)),
        ),
        tuple(remarks(report)),
        Figure(tuple(panels(report)), columns=_COLUMNS),
        picture_first=True,
        key=key(report),
        cases=tuple(Case(one.limit, () if one.holds else (one.text,)) for one in judged)
        or (Case('measured'),),
    )


def _recording(report: LostMotion, limits: Limits) -> Mapping[str, Any]:
    recording, both = report.recording, report.recording.encoders
    judged = limits.judge(report)
    transmission = plain(report.transmission) or {}
    transmission.pop('spectra', None)
    return {
        'recording': report.name,
        'answer': answer(report),
        'limits': {one.limit: {'holds': one.holds, 'text': one.text} for one in judged},
        'columns': recording.columns,
        'samples': recording.rows,
        'error': recording.damage,
        'gear_ratio': str(report.gear_ratio),
        'fitted_ratio': plain(report.fitted),
        **(_figures(report.figures) if report.figures else {}),
        'measured': report.measured,
        'transmission': transmission or None,
        'encoders': both
        and {
            'delay_unit': 's' if both.timed else 'rows',
            'rotor_step': both.rotor_step_at_output(report.gear_ratio).size,
            'rotor_step_source': both.rotor_step.source,
            'output_step': both.output_step.size,
            'output_step_source': both.output_step.source,
            'unmatched': both.unmatched,
        },
        'remarks': remarks(report),
    }


def _figures(found: GearFigures) -> dict[str, Any]:
    largest = found.largest
    return {
        'rated_torque': found.settings.rated_torque,
        'hysteresis': _with_unit(found.smallest.hysteresis, 'rad'),
        'lost_motion': _with_unit(largest.lost_motion, 'rad'),
        'lost_motion_without_friction': {
            'load': found.settings.small_load,
            **_with_unit(found.frictionless, 'rad'),
        },
        'friction': _with_unit(found.smallest.friction, 'N·m'),
        'backlash': _backlash(found.backlash),
        'stiffness': [_stiffness(stiffness) for stiffness in largest.stiffness],
        'overall_stiffness': largest.overall and _stiffness(largest.overall),
        'by_amplitude': [
            {
                'amplitude': figures.amplitude,
                'loops': figures.loops,
                'rate': figures.rate,
                'hysteresis': _with_unit(figures.hysteresis, 'rad'),
                'lost_motion': _with_unit(figures.lost_motion, 'rad'),
                'lost_motion_without_friction': _with_unit(figures.frictionless, 'rad'),
                'friction': _with_unit(figures.friction, 'N·m'),
                'backlash': _backlash(figures.backlash),
                'stiffness': [_stiffness(stiffness) for stiffness in figures.stiffness],
            }
            for figures in found.by_amplitude
        ],
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

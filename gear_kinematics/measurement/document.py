"""The report on lost motion as a document; docs/lost_motion.md describes its JSON."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from gear_kinematics.correction.uncertainty import COVERAGE, Estimate
from gear_kinematics.measurement.answer import Judgement, Limits, answer, remarks
from gear_kinematics.measurement.comparison import Comparison
from gear_kinematics.measurement.curves import panels
from gear_kinematics.measurement.figures import Figures, GearFigures, Stiffness
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
        summary(reports),
        '; '.join(found.sentence for found in comparisons),
    )


def _section(
    report: LostMotion, said: str, judged: Sequence[Judgement], remarked: Sequence[str]
) -> Section:
    passed = all(judgement.holds for judgement in judged)
    return Section(
        printable(report.name),
        (head(report), *tables(report)),
        (Verdict.PASS if passed else Verdict.FAIL) if judged else None,
        (
            *(Finding('finding', f'{one.text[0].upper()}{one.text[1:]}.') for one in judged),
            Finding('finding', said),
        ),
        tuple(remarked),
        Figure(tuple(panels(report)), columns=_COLUMNS),
        picture_first=True,
        key=key(report),
        cases=tuple(Case(one.limit, () if one.holds else (one.text,)) for one in judged)
        or (Case('measured'),),
    )


def _recording(
    report: LostMotion, said: str, judged: Sequence[Judgement], remarked: Sequence[str]
) -> Mapping[str, Any]:
    recording, both = report.recording, report.recording.encoders
    transmission = plain(report.transmission) or {}
    transmission.pop('spectra', None)
    return {
        'recording': report.name,
        'answer': said,
        'limits': {one.limit: {'holds': one.holds, 'text': one.text} for one in judged},
        'columns': recording.columns,
        'samples': recording.rows,
        'error': recording.damage,
        'gear_ratio': str(report.gear_ratio),
        'fitted_ratio': plain(report.fitted),
        **(_of_gear(report.figures) if report.figures else {}),
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
        'remarks': remarked,
    }


def _of_gear(found: GearFigures) -> dict[str, Any]:
    figures = _figures(found)
    figures['lost_motion_without_friction']['load'] = found.settings.small_load
    whole = found.largest.overall
    return {
        'rated_torque': found.settings.rated_torque,
        **figures,
        'overall_stiffness': _stiffness(whole) if whole else None,
        'by_amplitude': [
            {'amplitude': of.amplitude, 'loops': of.loops, 'rate': of.rate, **_figures(of)}
            for of in found.by_amplitude
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

"""The report on lost motion as a document; docs/lost_motion.md describes its JSON."""

from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from gear_kinematics.lost_motion.curves import panels
from gear_kinematics.lost_motion.remarks import remarks
from gear_kinematics.lost_motion.report import LostMotionReport
from gear_kinematics.lost_motion.several.compared import Compared
from gear_kinematics.lost_motion.tables import head, key, summary, tables
from gear_kinematics.report.document import (
    Document,
    Figure,
    Section,
    printable,
)
from gear_kinematics.state.uncertainty import COVERAGE, Estimate

SCHEMA = 'gear_kinematics/lost_motion'
VERSION = 1
_COLUMNS = 2
"""Panels side by side."""


def document(
    reports: Sequence[LostMotionReport], comparisons: Sequence[Compared] = ()
) -> Document:
    """Return the document on recordings, with a section for each, and then their comparisons."""
    return Document(
        'gearkin lost-motion',
        (*map(_section, reports), *(replace(found.section, leads=True) for found in comparisons)),
        {
            'schema': SCHEMA,
            'version': VERSION,
            'coverage': COVERAGE,
            'recordings': [_recording(report) for report in reports],
            **{
                key: plain(value)
                for comparison in comparisons
                for key, value in comparison.data.items()
            },
        },
        summary=summary(reports),
        totals='; '.join(filter(None, (comparison.sentence for comparison in comparisons))),
    )


def _section(report: LostMotionReport) -> Section:
    return Section(
        printable(report.recording.name),
        (head(report), *tables(report)),
        remarks=tuple(remarks(report)),
        figure=Figure(tuple(panels(report)), columns=_COLUMNS),
        picture_first=True,
        key=key(report),
    )


def _recording(report: LostMotionReport) -> Mapping[str, Any]:
    recording = report.recording
    motion = recording.motion
    return {
        'recording': recording.name,
        'columns': recording.columns,
        'samples': recording.rows,
        'error': recording.error,
        'gear_ratio': str(report.gear_ratio),
        'fitted_ratio': plain(report.fitted),
        'hysteresis': _without(report.hysteresis, 'ramps'),
        'transmission': _without(report.transmission, 'spectra'),
        'encoders': motion
        and {
            'delay_unit': 'rows' if motion.in_rows else 's',
            'rotor_step': motion.rotor_step.size,
            'rotor_step_source': motion.rotor_step.source,
            'output_step': motion.output_step.size,
            'output_step_source': motion.output_step.source,
            'unmatched': motion.unmatched,
        },
        'remarks': remarks(report),
    }


def _without(content: Any, curves: str) -> Any:
    members = plain(content)
    if members:
        del members[curves]
    return members


def plain(value: Any) -> Any:
    """Convert dataclasses to mappings for JSON, without arrays."""
    match value:
        case Estimate():
            return {
                'value': value.value,
                'standard_uncertainty': value.standard,
                'degrees_of_freedom': value.degrees_of_freedom,
                'expanded_uncertainty': value.uncertainty,
                'repeats': value.repeats,
            }
        case Fraction():
            return str(value)
        case Mapping():
            return {key: plain(item) for key, item in value.items()}
        case tuple() | list():
            return [plain(item) for item in value]
    if is_dataclass(value):
        members = {field.name: getattr(value, field.name) for field in fields(value)}
        return {
            name: plain(member)
            for name, member in members.items()
            if not isinstance(member, np.ndarray)
        }
    return value

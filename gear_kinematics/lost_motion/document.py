"""Lost motion as JSON, described in docs/lost_motion.md: rad, N·m, N·m/rad."""

from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from gear_kinematics.lost_motion import wording
from gear_kinematics.lost_motion.report import LostMotionReport
from gear_kinematics.lost_motion.uncertainty import COVERAGE, Estimate
from gear_kinematics.report.json import dumps

SCHEMA = 'gear_kinematics/lost_motion'
VERSION = 1


def to_json(reports: Sequence[LostMotionReport]) -> str:
    """Write the reports."""
    return dumps(
        {
            'schema': SCHEMA,
            'version': VERSION,
            'coverage': COVERAGE,
            'recordings': [_recording(report) for report in reports],
        }
    )


def _recording(report: LostMotionReport) -> Mapping[str, Any]:
    recording = report.recording
    motion = recording.motion
    return {
        'recording': recording.name,
        'columns': recording.columns,
        'samples': recording.rows,
        'error': recording.error,
        'hysteresis': _without(report.hysteresis, 'ramps'),
        'transmission': _without(report.transmission, 'spectra'),
        'encoders': motion
        and {
            'rotor_step': motion.rotor_step,
            'output_step': motion.output_step,
            'unmatched': motion.unmatched,
        },
        'remarks': wording.remarks(report),
    }


def _without(content: Any, curves: str) -> Any:
    plain = _plain(content)
    if plain:
        del plain[curves]
    return plain


def _plain(value: Any) -> Any:
    """Turn dataclasses into mappings; curves are for plots, not for here."""
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
        case np.ndarray():
            return None
        case tuple():
            return [_plain(item) for item in value]
    if is_dataclass(value):
        return {field.name: _plain(getattr(value, field.name)) for field in fields(value)}
    return value

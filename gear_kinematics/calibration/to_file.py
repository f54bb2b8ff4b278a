"""The calibration file of a fit."""

from datetime import UTC, datetime

import numpy as np

from gear_kinematics.calibration.normal import Array
from gear_kinematics.calibration.result import Fit, Fitted, Residuals
from gear_kinematics.calibration.terms import OrderTerm, StopTerm, TorqueTerm
from gear_kinematics.state.calibration_file import (
    Calibration,
    Compliance,
    Order,
    Prediction,
    Recording,
    Spans,
    Stop,
)
from gear_kinematics.state.share import version

_MARGIN = 0.1
"""Share of the span of speed and torque beyond which they are not calibrated."""


def to_calibration(fit: Fit) -> Calibration:
    """Convert a fit to the content of a calibration file."""
    mechanism = fit.mechanism
    teeth = (mechanism.ring_teeth, mechanism.satellite_teeth) if mechanism else (None, None)
    # The order in the file: orders, stops, compliance.
    kinds = (OrderTerm, StopTerm, TorqueTerm)
    terms = sorted(fit.terms, key=lambda fitted: kinds.index(type(fitted.term)))
    return Calibration(
        made_by=f'gearkin calibrate {version()}',
        created=datetime.now(UTC).isoformat(timespec='seconds'),
        recordings=tuple(map(_recording, fit.recordings)),
        gear_ratio=fit.ratio,
        ring_teeth=teeth[0],
        satellite_teeth=teeth[1],
        constant=fit.constant,
        orders=tuple(
            Order(f.term.name, f.term.cycles, *f.coefficients.tolist())
            for f in terms
            if isinstance(f.term, OrderTerm)
        ),
        hysteresis=tuple(
            Stop(f.term.radius, float(f.coefficients[0]) / f.term.radius)
            for f in terms
            if isinstance(f.term, StopTerm)
        ),
        compliance=next(
            (_compliance(f, f.term) for f in terms if isinstance(f.term, TorqueTerm)), None
        ),
        covariance=_covariance(fit, terms),
        half_width=fit.half_width,
        outside_half_width=fit.outside_half_width,
        spans=_spans(fit.recordings),
        validation=Prediction(fit.rms_before, fit.rms_after, fit.coverage),
    )


def _recording(residuals: Residuals) -> Recording:
    recording = residuals.samples.recording
    return Recording(
        recording.name,
        recording.sha256,
        len(recording.measured),
        recording.duration,
        residuals.zero,
    )


def _compliance(fitted: Fitted, term: TorqueTerm) -> Compliance:
    return Compliance(float(fitted.coefficients[0]) / term.deviation, term.mean)


def _scale(fitted: Fitted) -> list[float]:
    """Factors from the coefficients of a term to those of the file."""
    match fitted.term:
        case StopTerm(radius):
            return [1.0 / radius]
        case TorqueTerm():
            return [1.0 / fitted.term.deviation]
    return [1.0] * fitted.term.columns


def _covariance(fit: Fit, terms: list[Fitted]) -> tuple[tuple[float, ...], ...]:
    ends = dict(zip(fit.terms, np.cumsum([f.term.columns for f in fit.terms]), strict=True))
    places = [place for f in terms for place in range(ends[f] - f.term.columns, ends[f])]
    scale = np.concatenate([[], *map(_scale, terms)])
    matrix = fit.covariance[np.ix_(places, places)] * np.multiply.outer(scale, scale)
    return tuple(map(tuple, matrix.tolist()))


def _spans(recordings: tuple[Residuals, ...]) -> Spans:
    samples = [residuals.samples for residuals in recordings]
    torques = [s.torque for s in samples if s.torque is not None]
    speeds = [s.speed for s in samples if s.recording.timed]
    # Outputs of the recordings count from different whole turns.
    outputs = [s.output + s.first_output for s in samples]
    return Spans(
        _span(speeds, _MARGIN) if len(speeds) == len(samples) else None,
        _span(torques, _MARGIN) if len(torques) == len(samples) else None,
        _span(outputs, 0.0),
        sum(s.recording.duration for s in samples),
    )


def _span(columns: list[Array], margin: float) -> tuple[float, float]:
    low = min(float(np.min(column)) for column in columns)
    high = max(float(np.max(column)) for column in columns)
    return low - margin * (high - low), high + margin * (high - low)

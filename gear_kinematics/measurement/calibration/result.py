"""What the calibration of a gear consists of, and its calibration file."""

from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from fractions import Fraction
from typing import NamedTuple, TypeVar

import numpy as np

from gear_kinematics.correction import calibration_file as file
from gear_kinematics.correction.uncertainty import Estimate
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.measurement.calibration.spectrum import Spectrum
from gear_kinematics.measurement.calibration.terms import (
    OrderTerm,
    Samples,
    StopTerm,
    Term,
    TorqueTerm,
)
from gear_kinematics.measurement.ratio import RatioEstimate
from gear_kinematics.measurement.recording import Array
from gear_kinematics.share import version

_Kind = TypeVar('_Kind', OrderTerm, StopTerm, TorqueTerm)
_MARGIN = 0.1  # share of the span of speed and torque beyond which they are not calibrated


class FittedTerm(NamedTuple):
    """A term of the calibration."""

    term: Term
    coefficients: Array
    """In the units of the calibration file."""
    amplitude: Estimate
    """rad; of a stop operator and of the wind-up with its sign."""


class FittedRecording(NamedTuple):
    """The error of one recording less its zero and delay, (n,) each, of the used samples, rad."""

    samples: Samples
    before: Array
    """Without the correction."""
    after: Array
    """With the correction that was fitted without the half that holds the sample."""
    zero: float
    """rad: what the encoder's zero adds."""
    delay: Estimate | None
    """s: by how much the output's angles are late; taken out if clear; None if not separable."""


class Fit(NamedTuple):
    """The result; all angles are in rad."""

    ratio: Fraction
    mechanism: Mechanism | None
    terms: tuple[FittedTerm, ...]
    covariance: Array
    """Of all coefficients of the terms."""
    constant: float
    """Makes the mean deviation zero."""
    half_width: float
    """Of the interval that contains 95 % of the samples left out."""
    outside_half_width: float
    """The same for conditions that were not calibrated."""
    coverage: float
    """Share of samples within the interval from the other half."""
    rms_before: float
    rms_after: float
    """Of samples left out."""
    helps: bool
    """Whether the correction reduces the error by more than a standard error."""
    recordings: tuple[FittedRecording, ...]
    spectra: tuple[Spectrum | None, ...]
    """Before and after."""
    refused: Mapping[str, str]
    """Terms that the recordings cannot determine, with the cause."""
    fitted_ratio: RatioEstimate | None
    """The ratio, if it was fitted."""

    @property
    def timed(self) -> bool:
        """Whether time was recorded."""
        return all(r.samples.encoders.timed for r in self.recordings)


def to_calibration(fit: Fit) -> file.Calibration:
    """Convert a fit to the content of a calibration file."""
    # The order in the file: orders, stops, compliance.
    kinds = [OrderTerm, StopTerm, TorqueTerm]
    kind_of = [kinds.index(type(f.term)) for f in fit.terms for _ in f.coefficients]
    places = np.argsort(kind_of, kind='stable')
    samples = [r.samples for r in fit.recordings]
    torques = [s.torque for s in samples if s.torque is not None]
    return file.Calibration(
        made_by=f'gearkin calibrate {version()}',
        created=datetime.now(UTC).isoformat(timespec='seconds'),
        recordings=tuple(
            file.Recording(
                s.recording.name, s.recording.sha256, len(s.error), s.encoders.duration, zero
            )
            for s, _, _, zero, _ in fit.recordings
        ),
        gear_ratio=fit.ratio,
        ring_teeth=fit.mechanism.ring_teeth if fit.mechanism else None,
        satellite_teeth=fit.mechanism.satellite_teeth if fit.mechanism else None,
        constant=fit.constant,
        orders=tuple(file.Order(t.name, t.cycles, *c) for t, c in _of(OrderTerm, fit)),
        hysteresis=tuple(file.Stop(t.radius, *c) for t, c in _of(StopTerm, fit)),
        compliance=next((file.Compliance(c[0], t.mean) for t, c in _of(TorqueTerm, fit)), None),
        covariance=tuple(map(tuple, fit.covariance[np.ix_(places, places)].tolist())),
        half_width=fit.half_width,
        outside_half_width=fit.outside_half_width,
        spans=file.Spans(
            _span([s.speed for s in samples], _MARGIN) if fit.timed else None,
            _span(torques, _MARGIN) if len(torques) == len(samples) else None,
            _span([s.output for s in samples], 0.0),
            sum(s.encoders.duration for s in samples),
        ),
        validation=file.Prediction(fit.rms_before, fit.rms_after, fit.coverage),
    )


def _of(kind: type[_Kind], fit: Fit) -> list[tuple[_Kind, list[float]]]:
    """Terms of a kind with their coefficients."""
    return [(f.term, f.coefficients.tolist()) for f in fit.terms if isinstance(f.term, kind)]


def _span(columns: Sequence[Array], margin: float) -> tuple[float, float]:
    low = min(float(np.min(column)) for column in columns)
    high = max(float(np.max(column)) for column in columns)
    return low - margin * (high - low), high + margin * (high - low)

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The calibration of a gear: the deviation of its output angle, fitted to recordings.

deviation = constant + Σ orders of the rotor's angle + Σ stop operators + wind-up by the torque

is linear in its coefficients. Only terms that improve the prediction of left-out blocks are kept.
The interval is that of the errors in left-out parts, and the uncertainties of the coefficients are
those of the jackknife over the blocks, so that noise need not be white.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from fractions import Fraction
from typing import Any

import numpy as np

from gear_kinematics.correction.calibration_file import (
    WIDEST,
    Calibration,
    Compliance,
    Order,
    Prediction,
    Spans,
    Stop,
    UsedRecording,
)
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.measurement.calibration import terms as candidates
from gear_kinematics.measurement.calibration.model import (
    TOGETHER,
    GearModel,
    half_width,
    without_delays,
)
from gear_kinematics.measurement.calibration.terms import Samples, thinned
from gear_kinematics.measurement.gate import NO_ENCODER
from gear_kinematics.measurement.ratio import not_followed, wrong_ratio
from gear_kinematics.measurement.recording import Array, Recording, RecordingError
from gear_kinematics.measurement.sentences import Observation, Observed
from gear_kinematics.share import version
from gear_kinematics.statistics.uncertainty import Estimate, jackknife

_FEWEST = 100  # samples of a recording
_LEAST_COVERAGE = 0.9  # share of left-out samples within the 95 % interval
_WORTH = 0.5  # share of the original error: if less remains, few errors are beyond the interval
_MOST = 0.75  # share of the variance from which on a step explains the remaining error
_MATTERS = 0.25  # share of the original error from which on a step matters
_MARGIN = 0.1  # share by which the calibrated spans of speed and torque exceed the recorded ones


@dataclass(frozen=True, slots=True)
class FittedTerm:
    """A term of the calibration, as the report shows it."""

    name: str
    cycles: Fraction | None  #: cycles of an order per turn of the rotor
    radius: float | None  #: radius of a stop operator, rad
    amplitude: Estimate  #: rad; signed for a stop operator and the wind-up
    cause: str  #: likely cause, in words


@dataclass(frozen=True, eq=False, slots=True)
class Fit:
    """The result of a calibration; arrays are of the used samples of all recordings, (n,), rad."""

    calibration: Calibration  #: with a mean deviation of zero, and the errors of left-out samples
    helps: bool  #: whether the error falls by more than a standard error, and the interval holds
    moved: Observed | None  #: how the output slipped or drifted against the rotor, if it did
    terms: tuple[FittedTerm, ...]
    recordings: Sequence[Recording]
    delays: Sequence[Estimate | None]  #: of the output's angles, s; None if not separable
    refused: Mapping[str, Observed]  #: causes of terms that cannot be determined, by their names
    output: Array  #: ideal output angle
    before: Array  #: error without the correction; zero and delay are removed
    after: Array  #: error with a correction that was fitted without the sample's part


def fit(
    recordings: Sequence[Recording], ratio: Fraction, mechanism: Mechanism | None = None
) -> Fit:
    """Calibrate a gear of an exact ratio i by one or more recordings.

    A mechanism adds the orders of its satellites and teeth.

    Raises:
        RecordingError: if the recordings do not suffice, or have another ratio.
    """
    recordings = thinned(recordings)
    for recording in recordings:
        if (count := len(recording.both.measured)) < _FEWEST:
            raise RecordingError(f'{recording.name}: {count} output angles are too few')
        if not np.ptp(recording.both.ideal(ratio)) > 0.0:
            raise RecordingError(f'{recording.name}: the rotor does not move')
        if wrong := wrong_ratio(recording.both, ratio):
            raise RecordingError(f'{recording.name}: {wrong}')
    samples = [Samples(recording, ratio) for recording in recordings]
    if (deviation := max(float(np.ptp(s.error)) for s in samples)) < NO_ENCODER:
        raise RecordingError(str(Observation.COMPUTED(deviation=deviation)))
    refused: dict[str, Observed] = {}
    orders = candidates.known_orders(samples, ratio, mechanism, refused)

    def model_of(shifts: Sequence[float]) -> GearModel:
        pairs = zip(recordings, shifts, strict=True)
        samples = [Samples(recording, ratio, shift) for recording, shift in pairs]
        others = (*candidates.stops(samples, refused), *candidates.wind_up(samples, refused))
        return GearModel(samples, [*orders, *others])  # in the order of the file

    model, delays = without_delays(model_of, len(recordings))
    return _result(model, ratio, mechanism, delays, refused)


def _result(
    model: GearModel,
    ratio: Fraction,
    mechanism: Mechanism | None,
    delays: Sequence[Estimate | None],
    refused: Mapping[str, Observed],
) -> Fit:
    samples, values = model.samples, model.values()
    deviation = model.coefficients[0] @ values
    constant = -float(deviation.mean())
    before, after, width, coverage = model.checked(values)
    travels = [s.output[s.used] for s in samples]
    motion = np.concatenate([travel - travel.mean() for travel in travels])
    names = ', '.join(s.recording.name for s in samples)
    if wrong := not_followed(motion, before, ratio):
        raise RecordingError(f'{names}: {wrong}')
    if width > WIDEST:
        raise RecordingError(
            f'{names}: the output scatters by ± {math.degrees(width):.3g}° against the rotor, '
            'more than that of a gear: turn slower, or read both encoders at once'
        )
    fitted = [*_fitted(model)]
    entries, terms = [entry for entry, _ in fitted], tuple(term for _, term in fitted)
    trends = sum(
        own.amplitude.value for own, term in zip(terms, model.terms, strict=True) if term.is_trend
    )
    # Beyond the calibrated angles, a trend can be wrong by all of its size.
    outside = half_width(before) + half_width(deviation + constant) + trends
    fits = model.coefficients[1:]
    covariance = (len(fits) - 1) * np.cov(fits.T, ddof=0).reshape(2 * fits.shape[1:])
    calibration = Calibration(
        made_by=f'gearkin calibrate {version()}',
        created=datetime.now(UTC).isoformat(timespec='seconds'),
        recordings=tuple(
            UsedRecording(
                s.recording.name,
                s.recording.sha256,
                len(s.error),
                s.encoders.duration,
                model.zero(k) - constant,
            )
            for k, s in enumerate(samples)
        ),
        gear_ratio=ratio,
        ring_teeth=mechanism.ring_teeth if mechanism else None,
        satellite_teeth=mechanism.satellite_teeth if mechanism else None,
        constant=constant,
        orders=tuple(entry for entry in entries if isinstance(entry, Order)),
        hysteresis=tuple(entry for entry in entries if isinstance(entry, Stop)),
        compliance=next((entry for entry in entries if isinstance(entry, Compliance)), None),
        covariance=tuple(map(tuple, covariance.tolist())),
        half_width=width,
        outside_half_width=max(width, outside),
        spans=Spans(
            _span([s.speed if s.encoders.timed else None for s in samples], _MARGIN),
            _span([s.torque for s in samples], _MARGIN),
            _span([s.output for s in samples], 0.0) or (0.0, 0.0),
            sum(s.encoders.duration for s in samples),
        ),
        validation=Prediction(
            float(np.sqrt(np.mean(before**2))), float(np.sqrt(np.mean(after**2))), coverage
        ),
    )
    found = calibration.validation
    falls = found.rms_after < found.rms_before and interval_holds(calibration)
    moved = _moved(samples, after, _MATTERS * found.rms_before)
    return Fit(
        calibration,
        falls and not moved and model.helps(),
        moved,
        terms,
        [s.recording for s in samples],
        delays,
        refused,
        np.concatenate(travels),
        before,
        after,
    )


def _fitted(model: GearModel) -> Iterator[tuple[Order | Stop | Compliance, FittedTerm]]:
    """Yield each term as an entry of the file, and as the report shows it."""
    for term, columns in zip(model.terms, model.columns, strict=True):
        fits = model.coefficients[:, columns]
        sizes = np.hypot(*fits.T) if len(columns) > 1 else fits[:, 0]
        amplitude = jackknife(term.unit * sizes, together=TOGETHER)
        values: dict[str, Any] = dict(zip(term.coefficients, fits[0].tolist(), strict=True))
        radius = getattr(term.entry, 'radius', None)
        shown = FittedTerm(term.name, term.cycles, radius, amplitude, term.cause)
        yield replace(term.entry, **values), shown


def _moved(samples: Sequence[Samples], after: Array, least: float) -> Observed | None:
    """Find a step of more than `least`, rad, that explains most of a recording's error."""
    ends = np.cumsum([len(s.used) for s in samples])[:-1]
    for s, left in zip(samples, np.split(after, ends), strict=True):
        count, sums = np.arange(1, len(left)), np.cumsum(left - left.mean())[:-1]
        explained = sums * sums * (1.0 / count + 1.0 / (len(left) - count))
        place = 1 + int(np.argmax(explained))
        angle = float(left[place:].mean() - left[:place].mean())
        if abs(angle) > least and explained[place - 1] > _MOST * len(left) * np.var(left):
            moment, timed = float(s.encoders.moment[s.used[place]]), s.encoders.timed
            name = s.recording.name
            return Observation.MOVED(recording=name, angle=angle, moment=moment, timed=timed)
    return None


def interval_holds(calibration: Calibration) -> bool:
    """Whether the interval describes the errors of left-out samples, few of which exceed it."""
    found = calibration.validation
    most = max(calibration.half_width, _WORTH * found.rms_before)
    return found.coverage >= _LEAST_COVERAGE and found.rms_after <= most


def _span(columns: Sequence[Array | None], margin: float) -> tuple[float, float] | None:
    """Return the range of all columns, widened by a share; None if a column is missing."""
    known = [column for column in columns if column is not None]
    if len(known) < len(columns):
        return None
    low = min(float(np.min(column)) for column in known)
    high = max(float(np.max(column)) for column in known)
    return low - margin * (high - low), high + margin * (high - low)

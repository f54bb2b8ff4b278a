# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The calibration of a gear: what its output angle deviates by, fitted to recordings.

deviation = constant + Σ orders of the rotor's angle + Σ stop operators + wind-up by the torque.

It is linear in its coefficients. Terms stay that improve the prediction of blocks left out, and
the interval is that of the errors in parts left out; the coefficients' uncertainties are those of
the jackknife over the blocks. Neither needs white noise.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np

from gear_kinematics.correction.calibration_file import (
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
from gear_kinematics.measurement.calibration.selection import (
    TOGETHER,
    is_as_good,
    select,
    widening,
)
from gear_kinematics.measurement.calibration.terms import Recorded, Samples, Term, thinned
from gear_kinematics.measurement.ratio import wrong_ratio
from gear_kinematics.measurement.recording import Array, RecordingError
from gear_kinematics.share import version
from gear_kinematics.statistics.normal_equations import NormalEquations, block_bounds
from gear_kinematics.statistics.uncertainty import COVERAGE, Estimate, jackknife

_FEWEST = 100  # samples of a recording
_SHIFTS = 4  # corrections of the delays, each for what the ones before left
_SETTLED = 1e-5  # s to which a delay is corrected
_LEAST_COVERAGE = 0.9  # of samples left out, by the interval that should have 95 % of them
_MARGIN = 0.1  # share of the span of speed and torque beyond which they are not calibrated


@dataclass(frozen=True, slots=True)
class FittedTerm:
    """A term of the calibration, as the report shows it."""

    name: str
    cycles: Fraction | None
    """Of an order: per turn of the rotor."""
    radius: float | None
    """Of a stop operator, rad."""
    amplitude: Estimate
    """rad; of a stop operator and of the wind-up with its sign."""
    cause: str
    """The likely one, in words."""


@dataclass(frozen=True, slots=True)
class FittedRecording:
    """A recording that the calibration was made from."""

    used: UsedRecording
    delay: Estimate | None
    """s: by how much the output's angles are late; taken out if clear; None if not separable."""
    remarks: Sequence[str]


@dataclass(frozen=True, eq=False, slots=True)
class Fit:
    """The result; arrays are (n,), of the used samples of all recordings, in rad."""

    calibration: Calibration
    """Its constant makes the mean deviation zero; its errors are of samples left out."""
    helps: bool
    """Whether it reduces the error by more than a standard error, and its interval holds."""
    terms: tuple[FittedTerm, ...]
    recordings: tuple[FittedRecording, ...]
    refused: Mapping[str, str]
    """Terms that the recordings cannot determine, with the cause."""
    output: Array
    """Ideal output angle."""
    before: Array
    """Error less zero and delay, without the correction."""
    after: Array
    """The same with the correction that was fitted without the part that holds the sample."""


def fit(
    recordings: Sequence[Recorded],
    ratio: Fraction,
    mechanism: Mechanism | None = None,
) -> Fit:
    """Calibrate a gear.

    Args:
        recordings: at least one.
        ratio: i, exact.
        mechanism: for the orders of satellite and teeth, if it is known.

    Raises:
        RecordingError: if the recordings do not suffice, or have another ratio.
    """
    recordings = thinned(recordings)
    for recording, encoders in recordings:
        if (count := len(encoders.measured)) < _FEWEST:
            raise RecordingError(f'{recording.name}: {count} output angles are too few')
        if not np.ptp(encoders.ideal(ratio)) > 0.0:
            raise RecordingError(f'{recording.name}: the rotor does not move')
        if wrong := wrong_ratio(encoders, ratio):
            raise RecordingError(f'{recording.name}: {wrong}')
    samples = [Samples(*recording, ratio) for recording in recordings]
    if not any(np.ptp(s.error) > 0.0 for s in samples):
        raise RecordingError('the output angles are exactly those of the ratio: nothing to do')
    refused: dict[str, str] = {}
    orders = candidates.known_orders(samples, ratio, mechanism, refused)
    model, shifts = _Model(samples, orders, refused), [0.0] * len(recordings)
    for _ in range(_SHIFTS):
        delays = [model.delay(k, shift) for k, shift in enumerate(shifts)]
        late = [delay.value if delay and delay.clear else 0.0 for delay in delays]
        if np.allclose(late, shifts, rtol=0.0, atol=_SETTLED):
            break
        shifts = late
        samples = [
            Samples(recording, encoders.earlier(shift) if shift else encoders, ratio)
            for (recording, encoders), shift in zip(recordings, shifts, strict=True)
        ]
        model = _Model(samples, orders, refused)
    return _result(model, ratio, mechanism, delays, refused)


class _Model:
    """The linear model of recordings, with the terms that are worth it."""

    def __init__(
        self, samples: Sequence[Samples], orders: Sequence[Term], refused: dict[str, str]
    ) -> None:
        self.samples = samples
        terms = [
            *orders,
            *candidates.stops(samples, refused),
            *candidates.wind_up(samples, refused),
        ]  # in the order of the file
        common = sum(len(term.coefficients) for term in terms)
        own = range(common, common + 2 * len(samples))
        bounds = block_bounds([len(s.used) for s in samples])
        blocks = [(k, *ends) for k, edges in enumerate(bounds) for ends in pairwise(edges)]
        products = np.array([c.T @ c for c in (self._columns(terms, *of) for of in blocks)])
        chosen = select(NormalEquations(products), terms, own)
        self.terms = [terms[k] for k in chosen]
        # From here on, of the chosen terms alone.
        firsts = np.cumsum([0, *(len(term.coefficients) for term in terms)])
        places = [place for k in chosen for place in range(firsts[k], firsts[k + 1])]
        self._common = len(places)
        self._products = products[:, [*places, *own, -1]][:, :, [*places, *own, -1]]
        self._equations = NormalEquations(self._products)
        fits = self._equations.solve(range(self._common + len(own)))
        self.coefficients, self._own = np.split(fits, [self._common], axis=1)
        """Of the terms' columns, of all blocks and without each, (fits, columns)."""
        self._of = np.array([recording for recording, _, _ in blocks])
        self._counts = np.array([end - begin for _, begin, end in blocks])

    def _columns(self, terms: Sequence[Term], recording: int, begin: int, end: int) -> Array:
        """Columns of terms, of zero and delay of each recording, and the error."""
        s = self.samples[recording]
        at = s.used[begin:end]
        own = np.zeros((len(at), 2 * len(self.samples)))
        own[:, 2 * recording : 2 * recording + 2] = s.own_values(at)
        return np.column_stack([*(term.values(s, at) for term in terms), own, s.error[at]])

    def delay(self, recording: int, shift: float) -> Estimate | None:
        """Estimate the delay of a recording, s, of which `shift` has been taken out already."""
        if not self.samples[recording].tells_delay:
            return None
        return jackknife(shift + self._own[:, 2 * recording + 1], together=TOGETHER)

    def zero(self, recording: int) -> float:
        """What the zero of a recording's encoder adds, rad."""
        return self.samples[recording].offset + float(self._own[0, 2 * recording])

    def helps(self) -> bool:
        """Whether the terms improve the prediction by more than a standard error."""
        everything = range(self._products.shape[-1] - 1)
        without, best = map(self._equations.errors, (everything[self._common :], everything))
        return bool(self.terms) and not is_as_good(without, best)

    def deviation(self) -> Array:
        """What the terms add at the used samples of all recordings, rad."""
        return np.concatenate([self._terms_at(s) @ self.coefficients[0] for s in self.samples])

    def _terms_at(self, samples: Samples) -> Array:
        parts = [term.values(samples, samples.used) for term in self.terms]
        return np.concatenate([np.zeros((len(samples.used), 0)), *parts], axis=1)

    def checked(self) -> tuple[Array, Array, float, float]:
        """Predict parts of the samples as a check does, with a zero and a delay of their own.

        The parts are recordings or, of a single one, every other block, so that both have the
        same angles: a trend is not known at others.

        Returns:
            The errors without and with the correction of all used samples, rad; the half width of
            the interval, rad; and its coverage, each part judged by the width of the others.
        """
        parts = self._of if len(self.samples) > 1 else np.arange(len(self._of)) % 2
        equations, fold = NormalEquations(self._products, parts), np.repeat(parts, self._counts)
        fits = equations.solve(range(self._products.shape[-1] - 1))[1:, : self._common]
        own = np.concatenate([s.own_values(s.used) for s in self.samples])
        terms = np.concatenate([self._terms_at(s) for s in self.samples])
        before = np.concatenate([s.error[s.used] for s in self.samples])
        after = before - np.einsum('nc,nc->n', terms, fits[fold])
        for rows in (fold == part for part in set(parts)):
            for errors in (before, after):
                errors[rows] -= own[rows] @ np.linalg.lstsq(own[rows], errors[rows], rcond=None)[0]
        squares = np.add.reduceat(after**2, np.cumsum([0, *self._counts[:-1]]))
        half_width = widening(squares) * _half_width(after)
        inside = [np.abs(after[fold == k]) <= _half_width(after[fold != k]) for k in set(parts)]
        return before, after, half_width, float(np.mean(np.concatenate(inside)))


def _result(
    model: _Model,
    ratio: Fraction,
    mechanism: Mechanism | None,
    delays: Sequence[Estimate | None],
    refused: Mapping[str, str],
) -> Fit:
    samples, deviation = model.samples, model.deviation()
    constant = -float(deviation.mean())
    before, after, half_width, coverage = model.checked()
    entries, terms, trends, place = [], [], 0.0, 0
    for term in model.terms:
        fits = model.coefficients[:, place : place + len(term.coefficients)]
        place += len(term.coefficients)
        sizes = np.hypot(*fits.T) if len(term.coefficients) > 1 else fits[:, 0]
        amplitude = jackknife(term.unit * sizes, together=TOGETHER)
        entry: Any = term.entry
        entries.append(
            replace(entry, **dict(zip(term.coefficients, fits[0].tolist(), strict=True)))
        )
        radius = getattr(entry, 'radius', None)
        terms.append(FittedTerm(term.name, term.cycles, radius, amplitude, term.cause))
        trends += amplitude.value * term.is_trend
    # Beyond the calibrated angles, a trend can be as wrong as it becomes large.
    outside = _half_width(before) + _half_width(deviation + constant) + trends
    used = tuple(
        UsedRecording(
            s.recording.name,
            s.recording.sha256,
            len(s.error),
            s.encoders.duration,
            model.zero(k) - constant,
        )
        for k, s in enumerate(samples)
    )
    fits = model.coefficients[1:]
    covariance = (len(fits) - 1) * np.cov(fits.T, ddof=0).reshape(2 * fits.shape[1:])
    calibration = Calibration(
        made_by=f'gearkin calibrate {version()}',
        created=datetime.now(UTC).isoformat(timespec='seconds'),
        recordings=used,
        gear_ratio=ratio,
        ring_teeth=mechanism.ring_teeth if mechanism else None,
        satellite_teeth=mechanism.satellite_teeth if mechanism else None,
        constant=constant,
        orders=tuple(entry for entry in entries if isinstance(entry, Order)),
        hysteresis=tuple(entry for entry in entries if isinstance(entry, Stop)),
        compliance=next((entry for entry in entries if isinstance(entry, Compliance)), None),
        covariance=tuple(map(tuple, covariance.tolist())),
        half_width=half_width,
        outside_half_width=max(half_width, outside),
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
    falls = found.rms_after < found.rms_before and found.coverage >= _LEAST_COVERAGE
    recordings = (
        FittedRecording(of, delay, s.recording.sentences)
        for of, delay, s in zip(used, delays, samples, strict=True)
    )
    return Fit(
        calibration,
        falls and model.helps(),
        tuple(terms),
        tuple(recordings),
        refused,
        np.concatenate([s.output[s.used] for s in samples]),
        before,
        after,
    )


def _half_width(residuals: Array) -> float:
    return float(np.quantile(np.abs(residuals), COVERAGE))


def _span(columns: Sequence[Array | None], margin: float) -> tuple[float, float] | None:
    """From the least to the greatest value, and a share of that beyond; None if one lacks."""
    known = [column for column in columns if column is not None]
    if len(known) < len(columns):
        return None
    low = min(float(np.min(column)) for column in known)
    high = max(float(np.max(column)) for column in known)
    return low - margin * (high - low), high + margin * (high - low)

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The calibration of a gear: what its output angle deviates by, fitted to recordings.

deviation = constant + Σ orders of the rotor's angle + Σ stop operators + wind-up by the torque.

It is linear in its coefficients. Terms are selected by the prediction of blocks left out, and the
interval is that of the errors in halves left out; the coefficients' uncertainties are those of the
jackknife over the blocks. Neither needs white noise.
"""

import math
from collections.abc import Sequence
from datetime import UTC, datetime
from fractions import Fraction
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
from gear_kinematics.correction.uncertainty import COVERAGE, Estimate
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.measurement.calibration import terms as candidates
from gear_kinematics.measurement.calibration.result import Fit, FittedRecording, FittedTerm
from gear_kinematics.measurement.calibration.selection import (
    Block,
    NormalEquations,
    Selection,
    blocks_of,
    first_as_good,
    is_as_good,
    jackknife,
    widening,
)
from gear_kinematics.measurement.calibration.spectrum import Spectrum, as_fraction, spectrum
from gear_kinematics.measurement.calibration.terms import MOST_DRIFT, Recorded, Samples, thinned
from gear_kinematics.measurement.ratio import wrong_ratio
from gear_kinematics.measurement.recording import Array, Encoders, RecordingError
from gear_kinematics.share import version

_FEWEST = 100  # samples of a recording
_SHIFTS = 4  # corrections of the delays, each for what the ones before left
_ROUNDS = 3  # searches for further orders in the residuals
_PEAKS = 6  # peaks of the spectrum that are tried in each
_DELAY_TOLERANCE = 0.2  # share of its uncertainty to which a delay is corrected
_DRIFTS = (0, 2, 4, 8, MOST_DRIFT)  # numbers of waves of drift that are tried
_DELAY_DRIFT = 4
"""Waves of drift beside a delay. Measured on simulated gears: as many as improve the prediction
are too few where the zero drifts (over slow strokes the error is 1.14 times its least, not 1.03),
and 16 hide a delay of 2 ms in 15 s (the error falls to a fourth, not to a seventh)."""
_LONGEST_PERIOD = 2**20  # rotor turns after which all orders repeat, at most
_SEVERAL = 3  # recordings from which on terms are selected by leaving out a whole one, not a block
_COVERED = 0.5  # share of a half at angles that the other half contains, to be judged by it
_MARGIN = 0.1  # share of the span of speed and torque beyond which they are not calibrated
_OWN = (0, 1)  # a recording's own unknowns that a check determines as well: zero and delay


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
    return _Fitting(recordings, ratio, mechanism).result()


class _Fitting:
    """One fit with a given ratio: the selected terms, and what they tell."""

    def __init__(
        self,
        recordings: Sequence[Recorded],
        ratio: Fraction,
        mechanism: Mechanism | None,
    ) -> None:
        self._ratio, self._mechanism = ratio, mechanism
        self._refused: dict[str, str] = {}
        self._samples = [Samples(*recording, ratio) for recording in recordings]
        if not any(np.ptp(s.error) > 0.0 for s in self._samples):
            raise RecordingError('the output angles are exactly those of the ratio: nothing to do')
        self._orders = candidates.known_orders(self._samples, ratio, mechanism, self._refused)
        self._delays: list[Estimate | None] = [None] * len(recordings)
        self._undelay([encoders for _, encoders in recordings])
        self._drift = 0
        for _ in range(_ROUNDS):
            self._select()
            if not self._find_orders():
                break
        else:
            self._select()

    # Selection

    def _undelay(self, encoders: Sequence[Encoders]) -> None:
        """Estimate the delays of the output's angles, and take out those that are clear.

        An error of -speed · delay is told from hysteresis where the speed varies, and from drift
        since that is fitted as well.
        """
        shifts = [0.0] * len(encoders)
        late = [k for k, s in enumerate(self._samples) if s.tells_delay]
        for _ in range(_SHIFTS if late else 0):
            self._select(with_delays=True)
            equations = self._normal_equations(self._by_block, self._drift)
            before = shifts.copy()
            for k in late:
                delays = equations.own(k, self._selection.columns)[:, 1]
                self._delays[k] = delay = jackknife(shifts[k] + delays)
                shift = delay.value if delay.clear else 0.0
                if abs(shift - shifts[k]) > _DELAY_TOLERANCE * (delay.uncertainty or 0.0):
                    shifts[k] = shift
                    self._samples[k] = Samples(
                        self._samples[k].recording, encoders[k].earlier(shift), self._ratio
                    )
            if shifts == before:
                break

    def _select(self, *, with_delays: bool = False) -> None:
        """Select the terms, beside a delay of each recording or the drift that is needed."""
        self._own = _OWN if with_delays else _OWN[:1]
        wind_up = candidates.wind_up(self._samples, self._refused)
        stops = candidates.stops(self._samples, self._refused)
        self._terms = [*self._orders, *wind_up, *stops]
        self._blocks = blocks_of([len(s.used) for s in self._samples])
        of = np.array([block.recording for block in self._blocks])
        self._by_block = np.arange(len(of))
        self._by_part = of if len(self._samples) > 1 else (2 * self._by_block) // len(of)
        self._folds = of if len(self._samples) >= _SEVERAL else self._by_block
        self._products = np.array([c.T @ c for c in map(self._columns, self._blocks)])
        self._choose(_DELAY_DRIFT if with_delays else self._drift)
        if not self._drift:
            every = [self._normal_equations(self._folds, drift) for drift in _DRIFTS]
            errors = [equations.errors(self._selection.columns) for equations in every]
            if drift := _DRIFTS[first_as_good(errors)]:  # it improves the prediction
                self._choose(drift)

    def _columns(self, block: Block) -> Array:
        """Columns of the terms, of the recording's own unknowns, and the error."""
        s = self._samples[block.recording]
        at = s.used[block.rows]
        parts = [term.values(s, at) for term in self._terms]
        return np.column_stack([*parts, s.own_values(at), s.error[at]])

    def _choose(self, drift: int) -> None:
        """Choose among the terms, beside waves of drift."""
        self._drift = drift
        self._equations = self._normal_equations(self._folds, drift)
        # Any output has errors that vary slowly with its angle, and limit where others hold.
        fixed = int(bool(self._orders) and self._orders[0].is_trend)
        self._selection = Selection(self._equations, self._terms, fixed)

    def _normal_equations(
        self, folds: Array, drift: int, *, as_checked: bool = False
    ) -> NormalEquations:
        common = sum(len(term.coefficients) for term in self._terms)
        fitted = (*self._own, *range(len(_OWN), len(_OWN) + drift))
        # What is checked is like another recording, with unknowns of its own.
        predicted, groups = (_OWN, folds) if as_checked else (self._own, None)
        return NormalEquations(
            self._products, self._blocks, folds, common, fitted, predicted, groups
        )

    def _find_orders(self) -> bool:
        """Add further orders in the residuals; whether there are any."""
        found = self._spectrum(self._residuals(self._equations, self._selection.columns))
        if found is None:
            return False
        output, count = candidates.output_cycles(self._ratio), len(self._orders)
        for cycles in found.peaks(_PEAKS, min(float(output), 1.0)):
            exact = as_fraction(cycles, found.resolution, output)
            taken = {term.cycles for term in self._orders}
            period = math.lcm(*(of.denominator for of in (*taken, exact)))
            if exact and exact not in taken and period <= _LONGEST_PERIOD:
                self._orders.append(candidates.order_of(exact, self._ratio, self._mechanism))
        return len(self._orders) > count

    def _residuals(self, equations: NormalEquations, columns: Sequence[int]) -> Array:
        """Residuals of all used samples, each predicted without its fold, rad."""
        return np.concatenate([
            equations.residuals(k, self._columns(block), columns)
            for k, block in enumerate(self._blocks)
        ])  # fmt: skip

    def _by_recording(self, values: Array) -> list[Array]:
        return np.split(values, np.cumsum([len(s.used) for s in self._samples])[:-1])

    def _spectrum(self, errors: Array) -> Spectrum | None:
        angles = [s.rotor_turns[s.used] for s in self._samples]
        return spectrum(angles, self._by_recording(errors))

    # Results

    def _left_out(self) -> tuple[NormalEquations, Array, Array]:
        """Return equations whose prediction is that of a check, folds and covered of the samples.

        A check is of another part of the gear's life, with a zero and a delay of its own: halves
        of one recording, or each of several. Where those cover different angles, blocks are left.
        """
        counts = self._equations.counts
        fold = np.repeat(self._by_part, counts)
        output = np.concatenate([s.output[s.used] for s in self._samples])
        covered = np.ones(len(fold), bool)
        for left in np.unique(fold):
            known = output[fold != left]
            covered &= (fold != left) | ((known.min() <= output) & (output <= known.max()))
        if np.mean(covered) >= _COVERED:
            equations = self._normal_equations(self._by_part, self._drift, as_checked=True)
            return equations, fold, covered
        return self._equations, np.repeat(self._folds, counts), np.ones(len(fold), bool)

    def result(self) -> Fit:
        """Everything about the calibration with the selected terms."""
        columns, samples, mechanism = self._selection.columns, self._samples, self._mechanism
        coefficients = self._equations.solve(columns)
        equations, fold, covered = self._left_out()
        before, after = (self._residuals(equations, chosen) for chosen in ([], columns))
        deviation = np.concatenate([
            self._columns(block)[:, columns] @ coefficients[0] for block in self._blocks
        ])  # fmt: skip
        constant = -float(deviation.mean())
        zeros = [
            s.offset + float(self._equations.own(k, columns)[0, 0]) - constant
            for k, s in enumerate(samples)
        ]
        residuals = map(self._by_recording, (before, after))
        recordings = zip(samples, *residuals, zeros, self._delays, strict=True)
        errors = equations.errors(columns)
        half_width = widening(errors) * _half_width(after[covered])
        inside = [np.abs(after[fold == k]) <= _half_width(after[fold != k]) for k in set(fold)]
        terms = self._fitted_terms(coefficients)
        # Beyond the calibrated angles, a trend can be as wrong as it becomes large.
        trends = sum(t.amplitude.value for t in terms if t.term.is_trend)
        outside = _half_width(before) + _half_width(deviation + constant) + trends
        kinds: list[type] = [Order, Stop, Compliance]  # in the order of the file
        kind_of = [kinds.index(type(f.entry)) for f in terms for _ in f.term.coefficients]
        places = np.argsort(kind_of, kind='stable')
        of_kind: list[list[Any]] = [[f.entry for f in terms if type(f.entry) is k] for k in kinds]
        folds, size = len(coefficients) - 1, len(columns)
        covariance = (folds - 1) * np.cov(coefficients[1:, places].T, ddof=0).reshape(size, size)
        calibration = Calibration(
            made_by=f'gearkin calibrate {version()}',
            created=datetime.now(UTC).isoformat(timespec='seconds'),
            recordings=tuple(
                UsedRecording(
                    s.recording.name, s.recording.sha256, len(s.error), s.encoders.duration, zero
                )
                for s, zero in zip(samples, zeros, strict=True)
            ),
            gear_ratio=self._ratio,
            ring_teeth=mechanism.ring_teeth if mechanism else None,
            satellite_teeth=mechanism.satellite_teeth if mechanism else None,
            constant=constant,
            orders=tuple(of_kind[0]),
            hysteresis=tuple(of_kind[1]),
            compliance=of_kind[2][0] if of_kind[2] else None,
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
                float(np.sqrt(np.mean(before**2))),
                float(np.sqrt(np.mean(after**2))),
                float(np.mean(np.concatenate(inside))),
            ),
        )
        return Fit(
            calibration,
            helps=bool(columns) and not is_as_good(equations.errors([]), errors),
            terms=terms,
            recordings=tuple(FittedRecording(*recording) for recording in recordings),
            spectra=(self._spectrum(before), self._spectrum(after)),
            refused=self._refused,
        )

    def _fitted_terms(self, coefficients: Array) -> tuple[FittedTerm, ...]:
        found, first = [], 0
        for term in self._selection.chosen:
            mine = coefficients[:, first : first + len(term.coefficients)]
            first += len(term.coefficients)
            sizes = np.hypot(*mine.T) if len(term.coefficients) > 1 else mine[:, 0]
            amplitude = jackknife(term.unit * sizes)
            found.append(FittedTerm(term, term.fitted(mine[0].tolist()), amplitude))
        return tuple(found)


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

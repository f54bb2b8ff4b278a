"""One fit of the linear model with a given ratio: the selected terms, and what they tell."""

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np

from gear_kinematics.calibration import candidates
from gear_kinematics.calibration.blockwise import is_as_good, jackknife, widening
from gear_kinematics.calibration.model import (
    MOST_DRIFT,
    Model,
    Samples,
    blocks_of,
    term_values,
)
from gear_kinematics.calibration.normal import Array, NormalEquations, block_products
from gear_kinematics.calibration.recording import Recording, RecordingError
from gear_kinematics.calibration.result import Fit, Fitted, Residuals
from gear_kinematics.calibration.selection import Selection
from gear_kinematics.calibration.spectrum import Spectrum, as_fraction, spectrum
from gear_kinematics.calibration.terms import (
    OrderTerm,
    RatioTerm,
    StopTerm,
    Term,
    order_of,
    output_cycles,
)
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.state.uncertainty import COVERAGE, Estimate

_FEWEST = 100
"""Samples of a recording."""
_ROUNDS = 3
"""Searches for further orders in the residuals."""
_PEAKS = 6
"""Peaks of the spectrum that are tried in each."""
_DRIFTS = (0, 2, 4, 8, MOST_DRIFT)
"""Numbers of waves of drift that are tried."""
_LONGEST_PERIOD = 2**20
"""Rotor turns after which all orders repeat, at most."""


class Fitting:
    """One fit with a given ratio."""

    def __init__(
        self,
        recordings: Sequence[Recording],
        ratio: Fraction,
        mechanism: Mechanism | None,
        *,
        fit_ratio: bool = False,
    ) -> None:
        self._ratio = ratio
        self._mechanism = mechanism
        self._samples = [Samples(recording, ratio) for recording in recordings]
        self._check()
        self._refused: dict[str, str] = {}
        self._slope: list[RatioTerm] = []
        if fit_ratio:
            travel = max(float(np.ptp(s.output)) for s in self._samples)
            self._slope = [RatioTerm(travel)]
        self._orders, self._trends = candidates.orders(
            self._samples, ratio, mechanism, self._refused
        )
        self._wind_up = candidates.wind_up(self._samples, self._refused)
        self._drift = 0
        self._delayed = False

    def _check(self) -> None:
        for s in self._samples:
            name = s.recording.name
            if len(s.error) < _FEWEST:
                raise RecordingError(f'{name}: {len(s.error)} output angles are too few')
            if not np.ptp(s.output) > 0.0:
                raise RecordingError(f'{name}: the rotor does not move')

    # Selection

    def delays(self) -> list[Estimate | None]:
        """Estimate the delays of the output's stamps, of recordings in which they can be late.

        An error of -speed · delay is told from hysteresis where the speed varies, and from drift
        since that is eliminated.
        """
        known = [candidates.tells_delay(s) for s in self._samples]
        if not any(known):
            return [None] * len(known)
        self._drift, self._delayed = MOST_DRIFT, True
        self._choose_hysteresis()
        columns = self._selection.columns()
        every = range(self._model.drift.stop)
        equations = self._normal_equations(every, every)
        solutions = [equations.solve(columns), *equations.solve_without(columns)]
        estimates: list[Estimate | None] = []
        for number, told in enumerate(known):
            value, *repeats = (-float(equations.own(number, columns, c)[1]) for c in solutions)
            estimates.append(jackknife(value, repeats) if told else None)
        return estimates

    def select(self) -> None:
        """Select the terms."""
        if self._slope:
            self._trends = []  # they would leave hardly anything to the ratio
        stops = self._choose_hysteresis()
        for _ in range(_ROUNDS):
            found = self._found_orders()
            if not found:
                return
            before = set(self._chosen)
            self._orders += found
            self._choose(stops)
            if not set(self._chosen) - before:
                return

    def _choose_hysteresis(self) -> list[StopTerm]:
        """Select terms, first with coarse radii and then with finer ones, which are returned."""
        self._choose(candidates.coarse_stops(self._samples, self._refused))
        if not self._delayed:
            self._judge_drift()
        chosen = [term for term in self._chosen if isinstance(term, StopTerm)]
        stops = candidates.fine_stops(self._samples, chosen, self._refused)
        self._choose(stops)
        return stops

    def _choose(self, stops: Sequence[StopTerm]) -> None:
        """Select among these stop operators and all other terms."""
        terms: list[Term] = [
            *self._slope,
            *self._trends,
            *self._orders,
            *self._wind_up,
            *stops,
        ]
        candidates.use_known(self._samples, stops)
        self._blocks = blocks_of([len(s.used) for s in self._samples])
        self._model = Model(self._samples, terms)
        self._products = block_products(self._model.columns, self._blocks)
        self._equations = self._normal_equations(self._nuisance(self._drift), self._own())
        # Any output has errors that vary slowly with its angle, and limit where others hold.
        fixed = range(len(self._slope) + bool(self._trends))
        self._selection = Selection(self._equations, terms, fixed)
        self._selection.run(prune=not self._delayed)
        self._chosen = [terms[k] for k in self._selection.chosen]
        for k, other in self._selection.inseparable.items():
            self._refused[terms[k].name] = f'it cannot be told apart from {terms[other].name}'

    def _own(self) -> list[int]:
        """The own unknowns of a recording that its prediction may use while terms are selected."""
        return [0, *([self._model.speed] if self._delayed else [])]

    def _nuisance(self, drift: int) -> list[int]:
        """The own unknowns of a recording in the fit."""
        return [*self._own(), *self._model.drift[:drift]]

    def _normal_equations(self, nuisance: Sequence[int], own: Sequence[int]) -> NormalEquations:
        common = self._model.common
        places = ([common + place for place in part] for part in (nuisance, own))
        return NormalEquations(self._products, self._blocks, common, *places)

    def _judge_drift(self) -> None:
        """Fit as much drift of the zeros as improves the prediction."""
        columns, own = self._selection.columns(), self._own()
        errors = {
            k: self._normal_equations(self._nuisance(k), own).errors(columns) for k in _DRIFTS
        }
        best = min(errors.values(), key=lambda error: float(error.mean()))
        self._drift = next(k for k, error in errors.items() if is_as_good(error, best))

    def _found_orders(self) -> list[OrderTerm]:
        """Further orders in the residuals."""
        found = self._spectrum([r.after for r in self._residuals(self._own())])
        if not found:
            return []
        taken = {term.cycles for term in (*self._orders, *self._trends)}
        period = math.lcm(*(cycles.denominator for cycles in taken))
        orders = []
        output = output_cycles(self._ratio)
        for cycles in found.peaks(_PEAKS, min(float(output), 1.0)):
            exact = as_fraction(cycles, found.resolution, output)
            if exact is None or exact in taken:
                continue
            if (longer := math.lcm(period, exact.denominator)) <= _LONGEST_PERIOD:
                period = longer
                taken.add(exact)
                orders.append(order_of(exact, self._ratio, self._mechanism))
        return orders

    def _spectrum(self, errors: Sequence[Array]) -> Spectrum | None:
        return spectrum([s.rotor_turns[s.used] for s in self._samples], errors)

    # Results

    def _residuals(self, own: Sequence[int]) -> list[Residuals]:
        """Residuals of the used samples before and after the correction.

        Args:
            own: unknowns of a recording, of which the zero is the first, that its prediction uses.
        """
        columns = self._selection.columns()
        equations = self._normal_equations(self._nuisance(self._drift), own)
        without, folds = equations.solve_without(columns), equations.fold_of_block
        results = []
        for number, s in enumerate(self._samples):
            before, after = np.empty((2, len(s.used)))
            own_before = equations.own(number, [], np.zeros(0))
            for block, fold in zip(self._blocks, folds, strict=True):
                if block.recording != number:
                    continue
                at = s.used[block.rows]
                nuisance = self._model.own_values(s, at)[:, own]
                own_after = equations.own(number, columns, without[fold])
                before[block.rows] = s.error[at] - nuisance @ own_before
                after[block.rows] = s.error[at] - nuisance @ own_after
                after[block.rows] -= self._deviation(s, at, without[fold])
            zero = equations.own(number, columns, equations.solve(columns))[0]
            results.append(Residuals(s, before, after, s.offset + float(zero)))
        return results

    def _deviation(self, s: Samples, at: Array, coefficients: Array) -> Array:
        """What the chosen terms add up to."""
        parts = [term_values(term, s, at) for term in self._chosen]
        deviation: Array = np.column_stack([np.zeros((len(at), 0)), *parts]) @ coefficients
        return deviation

    def ratio(self) -> Estimate:
        """The ratio i with which nothing of the error grows with the angle."""
        columns = self._selection.columns()
        (slope,) = self._slope
        value, *repeats = [
            float(self._ratio) / (1.0 + float(coefficients[0]) / slope.travel)
            for coefficients in (
                self._equations.solve(columns),
                *self._equations.solve_without(columns),
            )
        ]
        return jackknife(value, repeats)

    def result(self) -> Fit:
        """Everything about the calibration with the selected terms."""
        columns = self._selection.columns()
        coefficients = self._equations.solve(columns)
        without = self._equations.solve_without(columns)
        residuals = self._residuals([0])
        before = np.concatenate([r.before for r in residuals])
        after = np.concatenate([r.after for r in residuals])
        deviation = np.concatenate(
            [self._deviation(s, s.used, coefficients) for s in self._samples]
        )
        constant = -float(deviation.mean())
        selection = self._selection
        judging = self._normal_equations(self._nuisance(self._drift), [0])
        means = [
            np.array([r.after[b.rows].mean() for b in self._blocks if b.recording == number])
            for number, r in enumerate(residuals)
        ]
        half_width = widening(judging.errors(columns), means) * _half_width(after)
        nothing = selection.errors([])
        fitted = self._fitted(coefficients, without)
        outside = _half_width(before) + _half_width(deviation + constant)
        # Beyond the calibrated angles, a trend can be as wrong as it becomes large.
        outside += sum(f.amplitude.value for f in fitted if f.term in self._trends)
        return Fit(
            self._ratio,
            self._mechanism,
            tuple(fitted),
            (len(without) - 1) * np.cov(without.T, ddof=0).reshape(2 * (len(columns),)),
            constant,
            half_width,
            max(half_width, outside),
            self._coverage(after),
            _rms(before),
            _rms(after),
            bool(self._chosen) and not is_as_good(nothing, selection.errors()),
            tuple(replace(r, zero=r.zero - constant) for r in residuals),
            (
                self._spectrum([r.before for r in residuals]),
                self._spectrum([r.after for r in residuals]),
            ),
            self._refused,
        )

    def _fitted(self, coefficients: Array, without: Array) -> list[Fitted]:
        place, fitted = 0, []
        for term in self._chosen:
            mine = slice(place, place + term.columns)
            place += term.columns
            if term.columns > 1:
                amplitude, *repeats = (math.hypot(*c[mine]) for c in (coefficients, *without))
            else:
                amplitude, *repeats = (float(c[mine][0]) for c in (coefficients, *without))
            fitted.append(Fitted(term, coefficients[mine], jackknife(amplitude, repeats)))
        return fitted

    def _coverage(self, after: Array) -> float:
        """Share of each fold's samples within the interval from the other folds."""
        fold = np.concatenate(
            [
                np.full(block.rows.stop - block.rows.start, number)
                for block, number in zip(self._blocks, self._equations.fold_of_block, strict=True)
            ]
        )
        inside = 0
        for number in range(int(fold.max()) + 1):
            mine = fold == number
            inside += int(np.count_nonzero(np.abs(after[mine]) <= _half_width(after[~mine])))
        return inside / len(after)


def _half_width(residuals: Array) -> float:
    return float(np.quantile(np.abs(residuals), COVERAGE))


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(np.square(values))))

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The linear model of the errors of a gear, fitted to recordings of both encoders.

Each recording has its own zero, and a delay between its encoders if that is separable. A clear
delay is taken out of the stamps, as the error is proportional to it only over short times.

Terms are removed unless each improves the prediction of blocks left out by more than one standard
error of the paired differences of the blocks (T. Hastie, R. Tibshirani, J. Friedman, The Elements
of Statistical Learning, 2nd ed., 2009, sections 3.3.2, 7.10).
"""

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from gear_kinematics.correction.calibration_file import Stop
from gear_kinematics.measurement.calibration.terms import Samples, Term, columns_of
from gear_kinematics.measurement.recording import Array
from gear_kinematics.statistics.normal_equations import NormalEquations, block_bounds
from gear_kinematics.statistics.uncertainty import (
    COVERAGE,
    Estimate,
    jackknife,
    standard_error,
    student_t,
)

TOGETHER = (1, 2, 4)  # successive blocks that are taken as one, in case neighbours are correlated
_MAX_DEGREES = 10**9  # of freedom
_SHIFTS = 4  # corrections of the delays, each of what the previous ones left
_SETTLED = 1e-5  # s to which a delay is corrected


class GearModel:
    """The linear model of recordings, with those terms that improve its prediction."""

    def __init__(self, samples: Sequence[Samples], terms: Sequence[Term]) -> None:
        """Fit zero and delay of each recording, and choose among the terms of the gear."""
        self.samples = samples
        columns = columns_of(terms)
        common = sum(map(len, columns))
        own = range(common, common + 2 * len(samples))
        bounds = block_bounds([len(s.used) for s in samples])
        blocks = [(k, *ends) for k, edges in enumerate(bounds) for ends in pairwise(edges)]
        products = np.array([r @ r.T for r in (self._rows(terms, *of) for of in blocks)])
        chosen = select(NormalEquations(products), terms, own)
        self.terms = [terms[k] for k in chosen]
        self.columns = columns_of(self.terms)
        # From here on, of the chosen terms alone.
        places = [place for k in chosen for place in columns[k]]
        self._common = len(places)
        self._products = products[:, [*places, *own, -1]][:, :, [*places, *own, -1]]
        self._equations = NormalEquations(self._products)
        fits = self._equations.solve(range(self._common + len(own)))
        self.coefficients, self._own = np.split(fits, [self._common], axis=1)
        """Coefficients of the terms, fitted to all blocks and without each, (fits, columns)."""
        self._of = np.array([recording for recording, _, _ in blocks])
        self._counts = np.array([end - begin for _, begin, end in blocks])

    def _rows(self, terms: Sequence[Term], recording: int, begin: int, end: int) -> Array:
        """Rows of terms, of zero and delay of each recording, and the error, at some samples."""
        s = self.samples[recording]
        at = s.used[begin:end]
        own = np.zeros((2 * len(self.samples), len(at)))
        own[2 * recording : 2 * recording + 2] = s.own_values(at)
        return np.vstack([*(term.values(s, at) for term in terms), own, s.error[at]])

    @property
    def delays(self) -> list[Estimate | None]:
        """Delay of each recording, s; None if inseparable from hysteresis."""
        return [
            jackknife(s.shift + fits, together=TOGETHER) if s.tells_delay else None
            for s, fits in zip(self.samples, self._own.T[1::2], strict=True)
        ]

    def zero(self, recording: int) -> float:
        """Offset of the error of a recording, which is due to the zero of its encoder, rad."""
        return self.samples[recording].offset + float(self._own[0, 2 * recording])

    def helps(self) -> bool:
        """Whether the terms improve the prediction by more than a standard error."""
        everything = range(self._products.shape[-1] - 1)
        without, best = map(self._equations.errors, (everything[self._common :], everything))
        return bool(self.terms) and not is_as_good(without, best)

    def values(self) -> Array:
        """Values of the terms at the used samples of all recordings, (columns, n)."""
        return np.hstack(
            [
                np.vstack([np.zeros((0, len(s.used))), *(t.values(s, s.used) for t in self.terms)])
                for s in self.samples
            ]
        )

    def checked(self, values: Array) -> tuple[Array, Array, float, float]:
        """Predict parts of the samples as a check does, with a zero and a delay of their own.

        `values` are those that `values()` returns, (columns, n).

        The parts are the recordings or, of a single one, alternate blocks, so that both cover the
        same angles: a trend is unknown at others.

        Returns:
            The errors without and with the correction of all used samples, rad; the half width of
            the interval, rad; and its coverage, each part judged by the width of the others.
        """
        parts = self._of if len(self.samples) > 1 else np.arange(len(self._of)) % 2
        equations, fold = NormalEquations(self._products, parts), np.repeat(parts, self._counts)
        fits = equations.solve(range(self._products.shape[-1] - 1))[1:, : self._common]
        own = np.hstack([s.own_values(s.used) for s in self.samples]).T
        before = np.concatenate([s.error[s.used] for s in self.samples])
        after = before - np.einsum('cn,cn->n', values, fits.T[:, fold])
        for rows in (fold == part for part in set(parts)):
            for errors in (before, after):
                errors[rows] -= own[rows] @ np.linalg.lstsq(own[rows], errors[rows], rcond=None)[0]
        squares = np.add.reduceat(after**2, np.cumsum([0, *self._counts[:-1]]))
        width = widening(squares) * half_width(after)
        inside = [np.abs(after[fold == k]) <= half_width(after[fold != k]) for k in set(parts)]
        return before, after, width, float(np.mean(np.concatenate(inside)))


def half_width(residuals: Array) -> float:
    """Return the half width of the interval that contains a share `COVERAGE` of residuals."""
    return float(np.quantile(np.abs(residuals), COVERAGE))


def without_delays(
    model_of: Callable[[Sequence[float]], GearModel], recordings: int
) -> tuple[GearModel, list[Estimate | None]]:
    """Fit a model, and fit it again with clear delays removed.

    `model_of` makes it with a given delay, s, removed from each recording. Returns the model and
    the delay of each recording, s; None if inseparable from hysteresis.
    """
    late = [0.0] * recordings
    model = model_of(late)
    for _ in range(_SHIFTS):
        delays = model.delays
        late = [delay.value if delay and delay.clear else 0.0 for delay in delays]
        if np.allclose(late, [s.shift for s in model.samples], rtol=0.0, atol=_SETTLED):
            break
        del model  # the states of its stop operators take as much memory as those of the next one
        model = model_of(late)
    return model, delays


def is_as_good(errors: Array, best: Array) -> bool:
    """Return whether errors of blocks exceed others by no more than a standard error."""
    difference = errors - best
    return bool(difference.mean() <= standard_error(difference, TOGETHER)[0])


def widening(errors: Array) -> float:
    """Factor by which an interval has to be wider because its width is an estimate itself.

    Student's t for the degrees of freedom with which the blocks' mean squares `errors` determine
    their mean (F. E. Satterthwaite, Biometrics Bulletin 2 (1946) 110), over the normal quantile.
    """
    variance = (standard_error(errors, TOGETHER)[0] / float(errors.mean())) ** 2
    degrees = 2.0 / max(variance, 1.0 / _MAX_DEGREES)
    return student_t(max(1, int(degrees))) / student_t(_MAX_DEGREES)


def select(equations: NormalEquations, terms: Sequence[Term], own: Sequence[int]) -> list[int]:
    """Choose among terms, whose columns are the first ones of the equations, in order.

    A leading trend stays, as any output has errors that vary slowly with its angle, and limit
    where others hold. The equations have single blocks as folds; the columns `own` are always
    fitted.
    """
    columns = columns_of(terms)

    def used(chosen: Sequence[int]) -> list[int]:
        return [*(place for k in chosen for place in columns[k]), *own]

    # The output lags by hysteresis, so that no coefficient of a stop operator is positive.
    lags = [isinstance(term.entry, Stop) for term in terms for _ in term.coefficients]
    fitted = equations.not_above_zero(np.array([*lags, *(False for _ in own)]))
    path = [[k for k, place in enumerate(columns) if fitted[place[0]]]]
    fixed = int(bool(terms) and terms[0].is_trend)
    while len(path[0]) > fixed:
        candidates = [k for k in path[0] if k >= fixed]
        without = equations.errors_without(used(path[0]), [columns[k] for k in candidates])
        gone = candidates[int(np.argmin(without.mean(axis=1)))]
        path.insert(0, [k for k in path[0] if k != gone])
    every = [equations.errors(used(chosen)) for chosen in path]
    best = min(every, key=lambda error: float(error.mean()))
    return next(c for c, error in zip(path, every, strict=True) if is_as_good(error, best))

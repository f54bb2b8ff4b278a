# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Normal equations of the linear model block by block, and uncertainties from these blocks.

Every fit without a block is the fit of all blocks less its normal equations, so that samples are
visited once. The unknowns of a recording alone, its zero, the delay of its stamps and the drift of
its zero, are eliminated (Schur complement). Blocks, not samples, are independent, as noise is
coloured.

Terms are selected by how well blocks that were left out of the fit are predicted: added while the
prediction improves, and then removed unless each improves it by more than one standard error of
the paired differences of the blocks (T. Hastie, R. Tibshirani, J. Friedman, The Elements of
Statistical Learning, 2nd ed., 2009, sections 3.3.2, 7.10).
"""

import math
from collections.abc import Sequence
from itertools import islice, pairwise
from typing import NamedTuple

import numpy as np

from gear_kinematics.correction.calibration_file import Stop
from gear_kinematics.correction.uncertainty import Estimate, pseudo_values, student_t
from gear_kinematics.measurement.calibration.terms import Term
from gear_kinematics.measurement.recording import Array

_BLOCKS = 24  # blocks of all recordings together
_RIDGE = 1e-9  # share of a column's sum of squares that keeps equations solvable
_SINGULAR = 1e-9
"""Share of the greatest eigenvalue below which an unknown of a recording is not determined."""
_TOGETHER = (1, 2, 4)
"""Numbers of successive blocks that are taken as one, in case neighbours are correlated."""
_FEWEST = 3  # groups of blocks from which a standard error is estimated
_MAX_DEGREES = 10**9  # of freedom
_MOST = 30  # terms of a model


class Block(NamedTuple):
    """Successive samples of one recording."""

    recording: int
    rows: slice
    """Of the samples that are used."""


def blocks_of(counts: Sequence[int]) -> list[Block]:
    """Divide recordings of so many samples into blocks about as long each, two at the least."""
    blocks = []
    for recording, count in enumerate(counts):
        parts = max(2, round(_BLOCKS * count / sum(counts)))
        bounds = np.linspace(0, count, parts + 1).astype(int).tolist()
        blocks += [Block(recording, slice(*ends)) for ends in pairwise(bounds) if np.ptp(ends)]
    return blocks


class NormalEquations:
    """Fits with folds of blocks left out, and how well they predict these.

    Arrays (fits, ...) are of the fit to all blocks, and then of those without each fold.
    """

    def __init__(
        self,
        products: Array,
        blocks: Sequence[Block],
        folds: Array,
        common: int,
        fitted: Sequence[int],
        predicted: Sequence[int],
        groups: Array | None = None,
    ) -> None:
        """Eliminate the recordings' own unknowns.

        Args:
            products: (blocks, size, size), of the columns (common, own, error) in each block.
            blocks: of the same length.
            folds: (blocks,), counted from 0; blocks of the same fold are left out together.
            common: number of columns with coefficients common to all recordings; the first ones.
            fitted: columns of a recording's own unknowns in a fit, counted from the first own one.
            predicted: those of which a prediction may use the values.
            groups: (blocks,): blocks of the same group have own unknowns in common when they are
                predicted; None: those of the same recording.
        """
        self.counts = np.array([block.rows.stop - block.rows.start for block in blocks])
        """Samples of each block."""
        self._common, self._fold = common, folds
        # Of the columns as they are: what own unknowns explain entirely must not be blown up.
        scale = np.sqrt(np.einsum('bii->i', products)[:common])
        self._scale = np.where(scale == 0.0, 1.0, scale)
        of = np.array([block.recording for block in blocks])
        kept = folds != np.arange(-1, folds.max() + 1)[:, None]
        mine = of == np.arange(of.max() + 1)[:, None]
        training = np.tensordot(1.0 * (kept[:, None] & mine), products, axes=1)
        self._fitted = _elimination(training, common, fitted)
        units = np.append(self._scale, 1.0)
        left = np.swapaxes(self._fitted, -1, -2) @ training @ self._fitted
        self.products = left.sum(axis=1) / np.outer(units, units)
        """Of the columns (common, error), each over its size, (fits, common + 1, common + 1)."""
        groups = of if groups is None else groups
        whole = np.tensordot(1.0 * (groups[:, None] == groups), products, axes=1)
        self._predicted = _elimination(whole, common, predicted)
        self._left = np.swapaxes(self._predicted, -1, -2) @ products @ self._predicted

    def solve(self, chosen: Sequence[int]) -> Array:
        """Coefficients of the chosen columns, (fits, chosen)."""
        places = list(chosen)
        # Also where a fold lacks what tells two columns apart.
        matrix = self.products[:, places][:, :, places] + _RIDGE * np.eye(len(places))
        solution = np.linalg.solve(matrix, self.products[:, places, -1:])
        coefficients: Array = solution[:, :, 0] / self._scale[places]
        return coefficients

    def _factors(self, chosen: Sequence[int]) -> Array:
        """The factors of the chosen columns and the error in a residual, (fits, chosen + 1)."""
        coefficients = self.solve(chosen)
        return np.concatenate([-coefficients, np.ones((len(coefficients), 1))], axis=1)

    def errors(self, chosen: Sequence[int]) -> Array:
        """Mean square of the residuals in each block, predicted without its fold, rad².

        Blocks count by their lengths, so that the mean over blocks is that over samples.
        """
        places = [*chosen, -1]
        factors = self._factors(chosen)[1 + self._fold]
        left = self._left[:, places][:, :, places]
        errors: Array = np.einsum('bi,bij,bj->b', factors, left, factors) / self.counts.mean()
        return errors

    def residuals(self, block: int, columns: Array, chosen: Sequence[int]) -> Array:
        """Residuals of a block predicted without its fold by chosen columns, (samples,), rad.

        Its columns (common, own, error) are (samples, size).
        """
        factors = self._factors(chosen)[1 + self._fold[block]]
        residuals: Array = columns @ (self._predicted[block][:, [*chosen, -1]] @ factors)
        return residuals

    def own(self, recording: int, chosen: Sequence[int]) -> Array:
        """A recording's own unknowns, (fits, own); 0 unless fitted."""
        maps = self._fitted[:, recording, self._common : -1][:, :, [*chosen, -1]]
        unknowns: Array = -np.einsum('fij,fj->fi', maps, self._factors(chosen))
        return unknowns


def _elimination(products: Array, common: int, own: Sequence[int]) -> Array:
    """Eliminate own unknowns from products of (common, own, error), (..., size, size).

    Returns:
        The map from (common, error) to (common, own, error) that minimises the residuals,
        (..., size, common + 1).
    """
    mine, others = [common + k for k in own], [*range(common), -1]
    rows = products[..., mine, :]
    square = rows[..., mine]
    size = np.sqrt(np.maximum(np.einsum('...ii->...i', square), np.finfo(float).tiny))[..., None]
    inverse = np.linalg.pinv(
        square / size / np.swapaxes(size, -1, -2), rcond=_SINGULAR, hermitian=True
    )
    place = np.zeros((*products.shape[:-1], common + 1))
    place[..., others, range(common + 1)] = 1.0
    place[..., mine, :] = -(inverse @ (rows[..., others] / size)) / size
    return place


def standard_error(values: Array) -> tuple[float, int]:
    """Standard error of the mean of blocks in the order of time, and its degrees of freedom.

    It is the greatest of those from single blocks and from groups of neighbours; 0 of fewer than
    three.
    """
    errors = [(0.0, 1)]
    for count in (len(values) // size for size in _TOGETHER):
        if count >= _FEWEST:
            means = [float(group.mean()) for group in np.array_split(values, count)]
            errors.append((float(np.std(means, ddof=1)) / math.sqrt(count), count - 1))
    return max(errors)


def is_as_good(errors: Array, best: Array) -> bool:
    """Whether errors of blocks are no greater than others by more than a standard error."""
    difference = errors - best
    return bool(difference.mean() <= standard_error(difference)[0])


def first_as_good(errors: Sequence[Array]) -> int:
    """Index of the first errors of blocks that are as good as those with the least mean."""
    best = min(errors, key=lambda error: float(error.mean()))
    return next(k for k, error in enumerate(errors) if is_as_good(error, best))


def widening(errors: Array) -> float:
    """Factor by which an interval has to be wider because its width is an estimate itself.

    Student's t for the degrees of freedom with which the blocks' mean squares `errors` determine
    their mean (F. E. Satterthwaite, Biometrics Bulletin 2 (1946) 110), over the normal quantile.
    """
    variance = (standard_error(errors)[0] / float(errors.mean())) ** 2
    degrees = 2.0 / max(variance, 1.0 / _MAX_DEGREES)
    return student_t(max(1, int(degrees))) / student_t(_MAX_DEGREES)


def jackknife(fits: Array) -> Estimate:
    """Estimate a quantity from its value, and those without each fold."""
    return Estimate(float(fits[0]), *standard_error(pseudo_values(fits)), len(fits) - 1)


class Selection:
    """Terms chosen among candidates."""

    def __init__(self, equations: NormalEquations, terms: Sequence[Term], fixed: int) -> None:
        """Choose among candidates, whose columns are the common ones of the equations, in order.

        The first `fixed` terms are always in the model.
        """
        self._equations, self._terms = equations, terms
        places = iter(range(sum(len(term.coefficients) for term in terms)))
        self._places = [list(islice(places, len(term.coefficients))) for term in terms]
        chosen = sorted(self._pruned(self._grown(list(range(fixed))), fixed))
        self.chosen = [terms[k] for k in chosen]
        """The terms."""
        self.columns = self._columns(chosen)
        """Their columns."""

    def _columns(self, chosen: Sequence[int]) -> list[int]:
        return [place for k in chosen for place in self._places[k]]

    def _errors(self, chosen: Sequence[int]) -> Array:
        return self._equations.errors(self._columns(chosen))

    def _score(self, chosen: Sequence[int]) -> float:
        """Mean square of the prediction, infinite if stop operators cancel each other."""
        stops = [isinstance(self._terms[k].entry, Stop) for k in chosen for _ in self._places[k]]
        if sum(stops) > 1:
            coefficients = self._equations.solve(self._columns(chosen))[0, stops]
            if np.ptp(np.sign(coefficients)):
                return np.inf
        return float(self._errors(chosen).mean())

    def _grown(self, chosen: list[int]) -> list[int]:
        """Add terms one by one, each the one that improves the prediction most."""
        best = self._score(chosen)
        while len(chosen) < _MOST and (others := set(range(len(self._terms))) - set(chosen)):
            score, k = min((self._score([*chosen, k]), k) for k in others)
            if not score < best:
                break
            chosen, best = [*chosen, k], score
        return chosen

    def _pruned(self, chosen: list[int], fixed: int) -> list[int]:
        """Remove terms that do not improve the prediction by more than a standard error."""
        path = [chosen]
        while len(path[0]) > fixed:
            smaller = [[k for k in path[0] if k != gone] for gone in path[0] if gone >= fixed]
            path.insert(0, min(smaller, key=lambda chosen: float(self._errors(chosen).mean())))
        return path[first_as_good([self._errors(chosen) for chosen in path])]

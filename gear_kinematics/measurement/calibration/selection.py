# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Normal equations of the linear model block by block, and uncertainties from these blocks.

Every fit without a block is the fit of all blocks less its normal equations, so that samples are
visited once. Blocks, not samples, are independent, as noise is coloured.

Terms are removed unless each improves the prediction of blocks left out by more than one standard
error of the paired differences of the blocks (T. Hastie, R. Tibshirani, J. Friedman, The Elements
of Statistical Learning, 2nd ed., 2009, sections 3.3.2, 7.10).
"""

import math
from collections.abc import Sequence
from itertools import islice

import numpy as np
from scipy.optimize import lsq_linear

from gear_kinematics.correction.calibration_file import Stop
from gear_kinematics.correction.uncertainty import Estimate, pseudo_values, student_t
from gear_kinematics.measurement.calibration.terms import Term
from gear_kinematics.measurement.recording import Array

_BLOCKS = 24  # blocks of all recordings together
_RIDGE = 1e-9  # share of a column's sum of squares that keeps equations solvable
_TOGETHER = (1, 2, 4)
"""Numbers of successive blocks that are taken as one, in case neighbours are correlated."""
_FEWEST = 3  # groups of blocks from which a standard error is estimated
_MAX_DEGREES = 10**9  # of freedom


def block_bounds(counts: Sequence[int]) -> list[list[int]]:
    """Divide recordings of so many samples into blocks about as long each, two at the least.

    Returns:
        Where the blocks of each recording begin, and where the last one ends.
    """
    parts = (max(2, round(_BLOCKS * count / sum(counts))) for count in counts)
    return [
        np.unique(np.linspace(0, count, most + 1).astype(int)).tolist()
        for count, most in zip(counts, parts, strict=True)
    ]


class NormalEquations:
    """Fits to all blocks and without folds of them, and how well these predict the folds.

    Arrays (fits, ...) are of the fit to all blocks, and then of those without each fold.
    """

    def __init__(self, products: Array, folds: Array | None = None) -> None:
        """Take products (blocks, size, size) of the columns and the error in each block.

        Blocks of the same number in `folds`, (blocks,), are left out together; None: each alone.
        """
        self._blocks = products
        self._fold = np.arange(len(products)) if folds is None else folds
        scale = np.sqrt(np.einsum('bii->i', products))
        self._scale = np.where(scale == 0.0, 1.0, scale)
        kept = self._fold != np.arange(-1, self._fold.max() + 1)[:, None]
        sums = np.tensordot(1.0 * kept, products, axes=1)
        self.products = sums / np.outer(self._scale, self._scale)
        """Of the columns and the error, each over its size, (fits, size, size)."""

    def regular(self, chosen: Sequence[int]) -> Array:
        """Products of the chosen columns that can be solved, (fits, chosen, chosen).

        They can also where a fold lacks what tells two columns apart.
        """
        places = list(chosen)
        matrices: Array = self.products[:, places][:, :, places] + _RIDGE * np.eye(len(places))
        return matrices

    def solve(self, chosen: Sequence[int]) -> Array:
        """Coefficients of the chosen columns, (fits, chosen)."""
        places = list(chosen)
        solution = np.linalg.solve(self.regular(places), self.products[:, places, -1:])
        coefficients: Array = solution[:, :, 0] * self._scale[-1] / self._scale[places]
        return coefficients

    def errors(self, chosen: Sequence[int]) -> Array:
        """Sum of the squared residuals of each block, predicted without its fold, rad²."""
        coefficients, places = self.solve(chosen)[1 + self._fold], [*chosen, -1]
        factors = np.column_stack([-coefficients, np.ones(len(coefficients))])
        products = self._blocks[:, places][:, :, places]
        errors: Array = np.einsum('bi,bij,bj->b', factors, products, factors)
        return errors


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


def select(equations: NormalEquations, terms: Sequence[Term], own: Sequence[int]) -> list[int]:
    """Choose among terms, whose columns are the first ones of the equations, in order.

    A leading trend stays: any output has errors that vary slowly with its angle, and limit where
    others hold.

    Args:
        equations: with single blocks as folds.
        terms: candidates.
        own: columns that are always fitted.
    """
    places = iter(range(len(own) + sum(len(term.coefficients) for term in terms)))
    columns = [list(islice(places, len(term.coefficients))) for term in terms]

    def errors(chosen: Sequence[int]) -> Array:
        return equations.errors([*(place for k in chosen for place in columns[k]), *own])

    # The output lags by hysteresis, so that no coefficient of a stop operator is positive.
    lags = [isinstance(term.entry, Stop) for term in terms for _ in term.coefficients]
    most = np.where([*lags, *(False for _ in own)], 0.0, np.inf)
    root = np.linalg.cholesky(equations.regular(range(len(most)))[0])
    right = np.linalg.solve(root, equations.products[0, :-1, -1])
    fitted = lsq_linear(root.T, right, (-np.inf, most), method='bvls')
    path = [[k for k, place in enumerate(columns) if fitted.active_mask[place[0]] == 0]]
    fixed = int(bool(terms) and terms[0].is_trend)
    while len(path[0]) > fixed:
        smaller = [[k for k in path[0] if k != gone] for gone in path[0] if gone >= fixed]
        path.insert(0, min(smaller, key=lambda chosen: float(errors(chosen).mean())))
    every = [errors(chosen) for chosen in path]
    best = min(every, key=lambda error: float(error.mean()))
    return next(c for c, error in zip(path, every, strict=True) if is_as_good(error, best))

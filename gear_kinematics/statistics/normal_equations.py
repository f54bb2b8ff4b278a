# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Normal equations of a linear model block by block.

Every fit without a block is the fit of all blocks less its normal equations, so that samples are
visited once. Blocks, not samples, are independent, as noise is coloured.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

_BLOCKS = 24  # blocks of all recordings together
_RIDGE = 1e-9  # share of a column's sum of squares that keeps equations solvable
_ROUNDING = 1e-13  # the least such share where something is expected of the coefficients
_PASSES = 3  # over the columns, after which rounding decides
_ALL, _WHOLE = slice(None), slice(1)  # fits: all of them, and that to all blocks


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

    noise: float | None = None
    """Variance of a sample where coefficients are expected to be about 1 in size, as if each had
    been measured to be 0 ± 1; None: nothing is expected of them."""

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
        """Normal matrices of the columns and the error, each over its size, (fits, size, size)."""

    def regular(self, chosen: Sequence[int], fits: slice = _ALL) -> Array:
        """Products of the chosen columns that can be solved, (fits, chosen, chosen).

        They can also where a fold lacks what tells two columns apart.
        """
        places, ridge = list(chosen), np.array(_RIDGE)
        if self.noise is not None:
            ridge = np.maximum(self.noise / self._scale[places] ** 2, _ROUNDING)
        diagonal = [*range(len(places))]
        if places == diagonal:  # as usual; lists would copy the matrices twice
            regular = self.products[fits, : len(places), : len(places)].copy()
        else:
            regular = self.products[fits, places][:, :, places]
        regular[:, diagonal, diagonal] += ridge
        return np.asarray(regular)

    def solve(self, chosen: Sequence[int], fits: slice = _ALL) -> Array:
        """Coefficients of the chosen columns, (fits, chosen)."""
        places = list(chosen)
        solution = np.linalg.solve(self.regular(places, fits), self.products[fits, places, -1:])
        return np.asarray(solution[:, :, 0] * self._scale[-1] / self._scale[places])

    def not_above_zero(self, limited: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Find the coefficients, (columns,), that are not 0 if no limited one may be positive.

        C. L. Lawson, R. J. Hanson, Solving Least Squares Problems, 1995, chapter 23.
        """
        matrix, right = self.regular(range(len(limited)), _WHOLE)[0], self.products[0, :-1, -1]
        free, best = ~limited, np.zeros(len(limited))
        for _ in range(_PASSES * len(limited)):
            new = np.zeros(len(limited))
            new[free] = np.linalg.solve(matrix[free][:, free], right[free])
            if len(beyond := np.flatnonzero(limited & (new > 0.0))):  # go as far as all allow
                shares = best[beyond] / (best[beyond] - new[beyond])
                best += shares.min() * (new - best)
                free[beyond[shares == shares.min()]] = False
                continue
            best, slope = new, np.where(free, 0.0, right - matrix @ new)
            if slope.min() > -_ROUNDING:
                break
            free[np.argmin(slope)] = True
        return free

    def first_order(self, chosen: Sequence[int]) -> Array:
        """Coefficients as of `solve`, but without each block by its influence, to first order.

        Folds are not heeded. Unlike that of exact fits, this scatter does not grow with the number
        of columns.
        """
        places, factors = list(chosen), self.residual(chosen)
        whole, left = -factors[places], (self._blocks @ factors)[:, places]
        changes = np.linalg.solve(self.regular(places, _WHOLE)[0], (left / self._scale[places]).T)
        return np.vstack([whole, whole - changes.T / self._scale[places]])

    def residual(self, chosen: Sequence[int]) -> Array:
        """Factors of the columns whose sum is the error less the fit to all blocks, (size,)."""
        factors = np.zeros(len(self._scale))
        factors[[*chosen]], factors[-1] = -self.solve(chosen, _WHOLE)[0], 1.0
        return factors

    def solve_for(self, chosen: Sequence[int], products: Array) -> Array:
        """Coefficients of the fit of other errors to all blocks, (chosen, errors).

        `products` are those of the chosen columns with these errors, (chosen, errors).
        """
        scale = self._scale[[*chosen], None]
        solution = np.linalg.solve(self.regular(chosen, _WHOLE)[0], products / scale)
        return np.asarray(solution / scale)

    def spreads(self, chosen: Sequence[int]) -> Array:
        """Standard uncertainties of the chosen coefficients by noise that is white, (chosen,)."""
        variances = np.diagonal(np.linalg.inv(self.regular(chosen, _WHOLE)[0]))
        return np.asarray(np.sqrt((self.noise or 0.0) * variances) / self._scale[list(chosen)])

    def errors(self, chosen: Sequence[int]) -> Array:
        """Sum of the squared residuals of each block, predicted without its fold, rad²."""
        coefficients, places = self.solve(chosen)[1 + self._fold], [*chosen, -1]
        factors = np.column_stack([-coefficients, np.ones(len(coefficients))])
        products = self._blocks[:, places][:, :, places]
        return np.asarray(np.einsum('bi,bij,bj->b', factors, products, factors))

    def errors_without(self, chosen: Sequence[int], groups: Sequence[Sequence[int]]) -> Array:
        """Errors as of `errors` without each of several groups of the chosen columns.

        One inverse serves all of them: without a group g, the coefficients β are
        β - V_g V_gg⁻¹ β_g, where V is the inverse of the normal matrix. Rounding matters more
        than in `errors`.

        Returns:
            One row for each group, (groups, blocks), rad².
        """
        places, fits = [*chosen, -1], 1 + self._fold
        inverse = np.linalg.inv(self.regular(chosen))[fits]
        whole = inverse @ self.products[:, places[:-1], -1:][fits]
        size = self._scale[places] / self._scale[-1]
        products = self._blocks[:, places][:, :, places] / np.outer(size, size)
        error, errors = np.ones((len(fits), 1, 1)), []
        for group in groups:
            rows = [places.index(column) for column in group]
            part = inverse[:, :, rows]
            less = part @ np.linalg.solve(part[:, rows], whole[:, rows])
            factors = np.concatenate([less - whole, error], axis=1)
            errors.append((factors * (products @ factors)).sum(axis=(1, 2)))
        return np.array(errors)

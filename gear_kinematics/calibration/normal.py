"""Normal equations of the linear model, block by block, and prediction of what is left out.

Every fit without a block is the fit of all blocks less its normal equations, so that samples are
visited once. The unknowns of a recording alone, its zero, the drift of its zero and the delay of
its stamps, are eliminated (Schur complement).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

_ROWS = 8192
"""Samples whose columns are computed at a time."""
_IN_ONE_THREAD = 2**18
"""Multiplications that OpenBLAS does not divide among threads."""
_SINGULAR = 1e-9
"""Share of the greatest eigenvalue below which an unknown of a recording is not determined."""


@dataclass(frozen=True, eq=False, slots=True)
class Block:
    """Successive samples of one recording."""

    recording: int
    fold: int
    """Blocks of the same fold are left out together."""
    rows: slice
    """Of the samples that are used."""


def block_products(columns_of: Callable[[int, slice], Array], blocks: Sequence[Block]) -> Array:
    """Sum the products of columns over each block.

    Args:
        columns_of: returns columns (common, own, error) of some samples of a recording,
            (samples, size).
        blocks: to sum over.

    Returns:
        (blocks, size, size).
    """
    products = []
    for block in blocks:
        total: Array | float = 0.0
        for start in range(block.rows.start, block.rows.stop, _ROWS):
            rows = slice(start, min(start + _ROWS, block.rows.stop))
            total = total + _products(columns_of(block.recording, rows))
        products.append(total)
    return np.array(products)


def _products(columns: Array) -> Array:
    """Product of columns with each other, computed in small parts.

    BLAS shares larger products among threads, which wait for each other on a busy machine.
    """
    count, size = columns.shape
    rows = max(8, _IN_ONE_THREAD // size**2)
    whole = count // rows * rows
    parts = columns[:whole].reshape(-1, rows, size)
    rest = columns[whole:]
    total: Array = np.matmul(parts.transpose(0, 2, 1), parts).sum(axis=0) + rest.T @ rest
    return total


class NormalEquations:
    """Fits with blocks left out, and how well they predict these blocks."""

    def __init__(
        self,
        products: Array,
        blocks: Sequence[Block],
        common: int,
        nuisance: Sequence[int],
        own: Sequence[int],
    ) -> None:
        """Eliminate the recordings' own unknowns.

        Args:
            products: as of `block_products`, (blocks, size, size); the error is the last column.
            blocks: of the same length.
            common: number of columns with coefficients common to all recordings; the first ones.
            nuisance: columns of a recording's own unknowns in the fit.
            own: those of them that a prediction may use as well.
        """
        self.common = common
        self.counts = np.array([block.rows.stop - block.rows.start for block in blocks], float)
        folds = sorted({block.fold for block in blocks})
        self.fold_of_block = np.array([folds.index(block.fold) for block in blocks])
        """Index of the fold of each block."""
        of = np.array([block.recording for block in blocks])
        recordings = sorted(set(of.tolist()))
        fitted = _part(products, common, nuisance)
        whole = {r: fitted[of == r].sum(axis=0) for r in recordings}
        self.total = np.sum([_reduced(whole[r], common) for r in recordings], axis=0)
        """(common + 1, common + 1), of the columns (common, error)."""
        self._training = np.zeros((len(folds), *self.total.shape))
        for fold in range(len(folds)):
            for r in recordings:
                left_out = (of == r) & (self.fold_of_block == fold)
                if np.count_nonzero(left_out) < np.count_nonzero(of == r):
                    rest = whole[r] - fitted[left_out].sum(axis=0)
                    self._training[fold] += _reduced(rest, common)
        # Residuals are about the zero of the whole recording, whatever was left out.
        predicted = _part(products, common, own)
        self._own = {r: _eliminated(predicted[of == r].sum(axis=0), common) for r in recordings}
        places = (self._own[r] for r in of)
        self._left = np.array(
            [place.T @ part @ place for place, part in zip(places, predicted, strict=True)]
        )

    def solve(self, chosen: Sequence[int]) -> Array:
        """Coefficients of the chosen columns from all blocks."""
        coefficients: Array = _solved(self.total[None], chosen)[0]
        return coefficients

    def solve_without(self, chosen: Sequence[int]) -> Array:
        """Coefficients without each fold, (folds, chosen)."""
        return _solved(self._training, chosen)

    def errors(self, chosen: Sequence[int]) -> Array:
        """Mean square of the residuals in each block, predicted without its fold, rad²."""
        places = [*chosen, self.common]
        coefficients = self.solve_without(chosen)[self.fold_of_block]
        vector = np.concatenate([-coefficients, np.ones((len(coefficients), 1))], axis=1)
        left = self._left[:, places][:, :, places]
        errors: Array = np.einsum('bi,bij,bj->b', vector, left, vector) / self.counts
        return errors

    def own(self, recording: int, chosen: Sequence[int], coefficients: Array) -> Array:
        """The recording's own unknowns, with given coefficients of the chosen columns."""
        elimination = self._own[recording][self.common : -1]
        vector = np.concatenate([-coefficients, [1.0]])
        own: Array = -elimination[:, [*chosen, self.common]] @ vector
        return own


def _part(products: Array, common: int, own: Sequence[int]) -> Array:
    """Products of the common columns, some of the others, and the error."""
    places = [*range(common), *own, products.shape[1] - 1]
    return products[:, places][:, :, places]


def _eliminated(products: Array, common: int) -> Array:
    """The map from (common, error) to (common, own, error) that minimises the residuals."""
    size = len(products)
    mine, others = slice(common, size - 1), [*range(common), size - 1]
    inverse = np.linalg.pinv(products[mine, mine], rcond=_SINGULAR, hermitian=True)
    place = np.zeros((size, common + 1))
    place[others, range(common + 1)] = 1.0
    place[mine] = -inverse @ products[mine][:, others]
    return place


def _reduced(products: Array, common: int) -> Array:
    place = _eliminated(products, common)
    return place.T @ products @ place


def _solved(products: Array, chosen: Sequence[int]) -> Array:
    if not len(chosen):
        return np.zeros((len(products), 0))
    places = list(chosen)
    matrix = products[:, places][:, :, places]
    right = products[:, places, -1]
    scale = np.sqrt(np.maximum(np.einsum('fii->fi', matrix), np.finfo(float).tiny))
    matrix = matrix / scale[:, :, None] / scale[:, None, :]
    # As exact as double precision allows, also where a fold lacks what tells two columns apart.
    matrix = matrix + 1e-12 * np.eye(len(places))
    solution: Array = np.linalg.solve(matrix, (right / scale)[:, :, None])[:, :, 0] / scale
    return solution

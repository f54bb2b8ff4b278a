"""Normal equations of the linear model block by block, and uncertainties from these blocks.

Every fit without a block is the fit of all blocks less its normal equations, so that samples are
visited once. The unknowns of a recording alone, its zero, the delay of its stamps and the drift of
its zero, are eliminated (Schur complement). Blocks, not samples, are independent, as noise is
coloured.
"""

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from gear_kinematics.measurement.recording import Array
from gear_kinematics.state.uncertainty import Estimate, student_t

_BLOCKS = 24
"""Blocks of all recordings together."""
_ROWS = 8192
"""Samples whose columns are computed at a time."""
_RIDGE = 1e-9
"""Share of a column's sum of squares that keeps equations solvable."""
_SINGULAR = 1e-9
"""Share of the greatest eigenvalue below which an unknown of a recording is not determined."""
_TOGETHER = (1, 2, 4)
"""Numbers of successive blocks that are taken as one, in case neighbours are correlated."""
_FEWEST = 3
"""Groups of blocks from which a standard error is estimated."""
_MANY = 10**9


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


def block_products(columns_of: Callable[[Block], Array], blocks: Sequence[Block]) -> Array:
    """Sum the products of columns over each block, (blocks, size, size).

    Args:
        columns_of: returns columns (common, own, error) of a part of a block, (samples, size).
        blocks: to sum over.
    """
    products = []
    for recording, rows in blocks:
        starts = range(rows.start, rows.stop, _ROWS)
        parts = (slice(start, min(start + _ROWS, rows.stop)) for start in starts)
        columns = (columns_of(Block(recording, part)) for part in parts)
        products.append(sum(part.T @ part for part in columns))
    return np.array(products)


class NormalEquations:
    """Fits with folds of blocks left out, and how well they predict these."""

    def __init__(
        self,
        products: Array,
        blocks: Sequence[Block],
        folds: Array,
        common: int,
        fitted: Sequence[int],
        predicted: Sequence[int],
        *,
        own_of_fold: bool = False,
    ) -> None:
        """Eliminate the recordings' own unknowns.

        Args:
            products: as of `block_products`; the error is the last column.
            blocks: of the same length.
            folds: (blocks,), counted from 0; blocks of the same fold are left out together.
            common: number of columns with coefficients common to all recordings; the first ones.
            fitted: columns of a recording's own unknowns in a fit.
            predicted: those of which a prediction may use the values.
            own_of_fold: whether a prediction's own unknowns are those of what was left out, as of
                another recording, not of the whole recording.
        """
        self.common, self.folds, self.predicted = common, folds, list(predicted)
        self.counts = np.array([block.rows.stop - block.rows.start for block in blocks], float)
        of = np.array([block.recording for block in blocks])
        fits, predictions = (_part(products, common, own) for own in (fitted, predicted))
        # Of the columns as they are: what own unknowns explain entirely must not be blown up.
        self._scale = np.sqrt(np.einsum('bii->i', products)[:common])
        self._scale[self._scale == 0.0] = 1.0

        def eliminated(kept: Array) -> tuple[list[Array], Array]:
            parts = [
                _eliminated(fits[kept & (of == r)].sum(axis=0), common) for r in np.unique(of)
            ]
            return [place for place, _ in parts], np.sum([rest for _, rest in parts], axis=0)

        self._own, self.total = eliminated(np.ones(len(of), bool))
        """`total`: products of the columns (common, error), (common + 1, common + 1)."""
        without = [eliminated(folds != fold) for fold in range(int(folds.max()) + 1)]
        self._own_without = [own for own, _ in without]
        self._training = np.array([rest for _, rest in without])
        self._own_predicted, left = [], []
        for r, fold, part in zip(of, folds, predictions, strict=True):
            same = (of == r) & (folds == fold) if own_of_fold else of == r
            place, _ = _eliminated(predictions[same].sum(axis=0), common)
            left.append(place.T @ part @ place)
            self._own_predicted.append(place)
        self._left = np.array(left)

    def solve(self, chosen: Sequence[int]) -> Array:
        """Coefficients of the chosen columns from all blocks."""
        coefficients: Array = self._solved(self.total[None], chosen)[0]
        return coefficients

    def solve_without(self, chosen: Sequence[int]) -> Array:
        """Coefficients without each fold, (folds, chosen)."""
        return self._solved(self._training, chosen)

    def _solved(self, products: Array, chosen: Sequence[int]) -> Array:
        places, scale = list(chosen), self._scale[list(chosen)]
        matrix = products[:, places][:, :, places] / np.multiply.outer(scale, scale)
        right = products[:, places, -1:] / scale[:, None]
        # Also where a fold lacks what tells two columns apart.
        matrix = matrix + _RIDGE * np.eye(len(places))
        solution: Array = np.linalg.solve(matrix, right)[:, :, 0] / scale
        return solution

    def errors(self, chosen: Sequence[int]) -> Array:
        """Mean square of the residuals in each block, predicted without its fold, rad².

        Blocks count by their lengths, so that the mean over blocks is that over samples.
        """
        places = [*chosen, self.common]
        vector = _residual(self.solve_without(chosen)[self.folds])
        left = self._left[:, places][:, :, places]
        errors: Array = np.einsum('bi,bij,bj->b', vector, left, vector) / self.counts.mean()
        return errors

    def own(self, recording: int, chosen: Sequence[int]) -> tuple[Array, Array]:
        """A recording's own unknowns, (own,), and those without each fold, (folds, own)."""
        maps = [own[recording] for own in (self._own, *self._own_without)]
        coefficients = [self.solve(chosen), *self.solve_without(chosen)]
        own = [self._mapped(*one, chosen) for one in zip(maps, coefficients, strict=True)]
        return own[0], np.array(own[1:])

    def predicted_own(self, block: int, chosen: Sequence[int], coefficients: Array) -> Array:
        """The own unknowns with which a block is predicted, with given coefficients."""
        return self._mapped(self._own_predicted[block], coefficients, chosen)

    def _mapped(self, place: Array, coefficients: Array, chosen: Sequence[int]) -> Array:
        own = place[self.common : -1, [*chosen, self.common]]
        unknowns: Array = -own @ _residual(coefficients[None])[0]
        return unknowns


def _residual(coefficients: Array) -> Array:
    """The factors of the columns and the error in a residual, (n, chosen + 1)."""
    return np.concatenate([-coefficients, np.ones((len(coefficients), 1))], axis=1)


def _part(products: Array, common: int, own: Sequence[int]) -> Array:
    """Products of the common columns, some of the own ones, and the error."""
    places = [*range(common), *(common + k for k in own), products.shape[1] - 1]
    return products[:, places][:, :, places]


def _eliminated(products: Array, common: int) -> tuple[Array, Array]:
    """Eliminate own unknowns from products of (common, own, error).

    Returns:
        The map from (common, error) to (common, own, error) that minimises the residuals, and the
        products of (common, error) with it.
    """
    size = len(products)
    mine, others = slice(common, size - 1), [*range(common), size - 1]
    own = products[mine, mine]
    scale = 1.0 / np.sqrt(np.maximum(np.diag(own), np.finfo(float).tiny))
    inverse = np.linalg.pinv(
        own * np.multiply.outer(scale, scale), rcond=_SINGULAR, hermitian=True
    )
    place = np.zeros((size, common + 1))
    place[others, range(common + 1)] = 1.0
    place[mine] = -scale[:, None] * (inverse @ (scale[:, None] * products[mine][:, others]))
    return place, place.T @ products @ place


class StandardError(NamedTuple):
    """Of the mean of blocks."""

    value: float
    degrees_of_freedom: int


def standard_error(values: Array) -> StandardError:
    """Standard error of the mean of blocks in the order of time; 0 of fewer than three.

    It is the greatest of those from single blocks and from groups of neighbours.
    """
    errors = [StandardError(0.0, 1)]
    for count in (len(values) // size for size in _TOGETHER):
        if count >= _FEWEST:
            means = [float(group.mean()) for group in np.array_split(values, count)]
            errors.append(
                StandardError(float(np.std(means, ddof=1)) / math.sqrt(count), count - 1)
            )
    return max(errors)


def is_as_good(errors: Array, best: Array) -> bool:
    """Whether errors of blocks are no greater than others by more than a standard error."""
    difference = errors - best
    return bool(difference.mean() <= standard_error(difference).value)


def widening(errors: Array) -> float:
    """Factor by which an interval has to be wider because its width is an estimate itself.

    Student's t for the degrees of freedom with which the blocks' mean squares `errors` determine
    their mean (F. E. Satterthwaite, Biometrics Bulletin 2 (1946) 110), over the normal quantile.
    """
    variance = (standard_error(errors).value / float(errors.mean())) ** 2
    degrees = min(2.0 / variance, _MANY) if variance else _MANY
    return student_t(max(1, int(degrees))) / student_t(_MANY)


def jackknife(value: float, repeats: Sequence[float]) -> Estimate:
    """Estimate a quantity from its values without each of the folds, by their pseudo-values.

    (B. Efron, C. Stein, Annals of Statistics 9 (1981) 586)
    """
    count = len(repeats)
    pseudo_values = count * value - (count - 1) * np.array(repeats)
    return Estimate(value, *standard_error(pseudo_values), count)

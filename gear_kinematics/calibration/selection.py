"""Selects terms by how well blocks that were left out of the fit are predicted.

Terms are added while the prediction improves, exchanged for better ones, and then removed again
unless each improves it by more than one standard error of the paired differences of the blocks
(T. Hastie, R. Tibshirani, J. Friedman, The Elements of Statistical Learning, 2nd ed., 2009,
sections 3.3.2, 7.10).
"""

from collections.abc import Sequence

import numpy as np

from gear_kinematics.calibration.blockwise import is_as_good
from gear_kinematics.calibration.normal import Array, NormalEquations
from gear_kinematics.calibration.terms import OrderTerm, StopTerm, Term

_MOST = 30
"""Terms of a model."""
_APART = 0.1
"""Share of an order's columns that the other orders must leave unexplained."""


class Selection:
    """Terms chosen among candidates."""

    def __init__(
        self, equations: NormalEquations, terms: Sequence[Term], fixed: Sequence[int]
    ) -> None:
        """Start with the fixed terms.

        Args:
            equations: whose common columns are those of the terms, in their order.
            terms: the candidates.
            fixed: indices of the terms that are always in the model.
        """
        self.terms = terms
        self.chosen: list[int] = list(fixed)
        self.inseparable: dict[int, int] = {}
        """Orders that cannot be told apart from another one that was chosen."""
        self._equations = equations
        self._fixed = frozenset(fixed)
        ends = np.cumsum([term.columns for term in terms])
        self._places = [
            list(range(end - term.columns, end)) for term, end in zip(terms, ends, strict=True)
        ]
        self._weights = equations.counts / equations.counts.mean()
        self._shares: dict[tuple[int, ...], float] = {}
        """What `_unexplained` has found, which each further term asks for again."""

    def columns(self, chosen: Sequence[int] | None = None) -> list[int]:
        """The columns of terms; of those chosen, if none are given."""
        return [
            place for k in (self.chosen if chosen is None else chosen) for place in self._places[k]
        ]

    def errors(self, chosen: Sequence[int] | None = None) -> Array:
        """Mean square of the residuals of each block, left out."""
        errors: Array = self._equations.errors(self.columns(chosen)) * self._weights
        return errors

    def run(self, *, prune: bool = True) -> None:
        """Choose the terms.

        Args:
            prune: whether to remove terms that may help by chance.
        """
        self.grow()
        self._exchange()
        if prune:
            self._prune()
        self.chosen.sort()

    def grow(self) -> None:
        """Add terms one by one, each the one that improves the prediction most."""
        best = float(self.errors().mean())
        while len(self.chosen) < _MOST:
            scores = {
                k: float(self.errors([*self.chosen, k]).mean())
                for k in range(len(self.terms))
                if k not in self.chosen
                and not self._is_inseparable(k)
                and self._is_monotonic([*self.chosen, k])
            }
            k = min(scores, key=lambda k: scores[k], default=None)
            if k is None or not scores[k] < best:
                return
            self.chosen.append(k)
            best = scores[k]

    def _exchange(self) -> None:
        """Replace the radius of each stop operator by a better one."""
        stops = [k for k, term in enumerate(self.terms) if isinstance(term, StopTerm)]
        best, before = float(self.errors().mean()), np.inf
        while best < before:
            before = best
            for place, k in enumerate(self.chosen):
                for other in stops if k in stops else ():
                    if other in self.chosen:
                        continue
                    trial = [*self.chosen[:place], other, *self.chosen[place + 1 :]]
                    if not self._is_monotonic(trial):
                        continue
                    if (error := float(self.errors(trial).mean())) < best:
                        best, self.chosen = error, trial

    def _prune(self) -> None:
        """Remove terms that do not improve the prediction by more than a standard error."""
        path = [list(self.chosen)]
        while set(path[-1]) - self._fixed:
            model = path[-1]
            gone = set(model) - self._fixed
            smaller = [[k for k in model if k != left_out] for left_out in gone]
            path.append(min(smaller, key=lambda chosen: float(self.errors(chosen).mean())))
        errors = [self.errors(chosen) for chosen in path]
        best = min(errors, key=lambda error: float(error.mean()))
        for chosen, error in zip(reversed(path), reversed(errors), strict=True):
            if is_as_good(error, best):
                self.chosen = chosen
                return

    def _is_monotonic(self, chosen: Sequence[int]) -> bool:
        """Whether all stop operators act in the same direction, and do not cancel each other."""
        stops = [
            place
            for k in chosen
            if isinstance(self.terms[k], StopTerm)
            for place in self._places[k]
        ]
        if len(stops) < 2:  # noqa: PLR2004
            return True
        columns = self.columns(chosen)
        coefficients = self._equations.solve(columns)
        signs = np.sign(coefficients[[columns.index(place) for place in stops]])
        return bool(np.all(signs == signs[0]))

    def _is_inseparable(self, k: int) -> bool:
        """Whether the chosen orders already explain an order."""
        if not isinstance(self.terms[k], OrderTerm):
            return False
        others = [c for c in self.chosen if isinstance(self.terms[c], OrderTerm)]
        for group in ([c] for c in others):
            if self._unexplained(k, group) < _APART:
                self.inseparable[k] = group[0]
                return True
        if others and self._unexplained(k, others) < _APART:
            self.inseparable[k] = others[0]
            return True
        return False

    def _unexplained(self, k: int, others: Sequence[int]) -> float:
        """Share of the variance of a term's columns that others leave, at the least."""
        key = (k, *others)
        if key not in self._shares:
            self._shares[key] = self._share_left(k, others)
        return self._shares[key]

    def _share_left(self, k: int, others: Sequence[int]) -> float:
        total = self._equations.total
        mine, theirs = self._places[k], self.columns(others)
        cross = total[np.ix_(theirs, mine)]
        explained = cross.T @ np.linalg.lstsq(total[np.ix_(theirs, theirs)], cross, rcond=1e-10)[0]
        own = total[np.ix_(mine, mine)]
        left = np.linalg.eigvals(
            np.linalg.pinv(own, rcond=1e-12, hermitian=True) @ (own - explained)
        )
        return float(left.real.min())

"""Selects terms by how well blocks that were left out of the fit are predicted.

Terms are added while the prediction improves, exchanged for better ones, and then removed again
unless each improves it by more than one standard error of the paired differences of the blocks
(T. Hastie, R. Tibshirani, J. Friedman, The Elements of Statistical Learning, 2nd ed., 2009,
sections 3.3.2, 7.10).
"""

from collections.abc import Sequence
from itertools import islice

import numpy as np

from gear_kinematics.measurement.calibration.normal import NormalEquations, first_as_good
from gear_kinematics.measurement.calibration.terms import OrderTerm, StopTerm, Term
from gear_kinematics.measurement.recording import Array

_MOST = 30  # terms of a model
_APART = 0.1  # share of an order's columns that the other orders must leave unexplained


class Selection:
    """Terms chosen among candidates."""

    def __init__(self, equations: NormalEquations, terms: Sequence[Term], fixed: int) -> None:
        """Choose among candidates, whose columns are the common ones of the equations, in order.

        The first `fixed` terms are always in the model.
        """
        self.inseparable: dict[str, str] = {}
        """Orders that cannot be told apart from another one that was chosen, with its name."""
        self._equations, self._terms = equations, terms
        places = iter(range(sum(term.columns for term in terms)))
        self._places = [list(islice(places, term.columns)) for term in terms]
        self._fixed = set(range(fixed))
        chosen = sorted(self._pruned(self._exchanged(self._grown(list(range(fixed))))))
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
        columns = self._columns(chosen)
        stops = [isinstance(self._terms[k], StopTerm) for k in chosen for _ in self._places[k]]
        if sum(stops) > 1 and np.ptp(np.sign(self._equations.solve(columns)[0, stops])):
            return np.inf
        return float(self._equations.errors(columns).mean())

    def _grown(self, chosen: list[int]) -> list[int]:
        """Add terms one by one, each the one that improves the prediction most."""
        best = self._score(chosen)
        while len(chosen) < _MOST:
            others = set(range(len(self._terms))) - set(chosen)
            scores = {
                k: self._score([*chosen, k]) for k in others if not self._is_inseparable(k, chosen)
            }
            k = min(scores, key=lambda k: scores[k], default=None)
            if k is None or not scores[k] < best:
                break
            chosen, best = [*chosen, k], scores[k]
        return chosen

    def _exchanged(self, chosen: list[int]) -> list[int]:
        """Replace the radius of each stop operator by a better one."""
        stops = {k for k, term in enumerate(self._terms) if isinstance(term, StopTerm)}
        best, before = self._score(chosen), np.inf
        while best < before:
            before = best
            for place in [place for place, k in enumerate(chosen) if k in stops]:
                for other in stops - set(chosen):
                    trial = [*chosen[:place], other, *chosen[place + 1 :]]
                    if (score := self._score(trial)) < best:
                        best, chosen = score, trial
        return chosen

    def _pruned(self, chosen: list[int]) -> list[int]:
        """Remove terms that do not improve the prediction by more than a standard error."""
        path = [chosen]
        while gone := set(path[-1]) - self._fixed:
            smaller = [[k for k in path[-1] if k != left_out] for left_out in gone]
            path.append(min(smaller, key=lambda chosen: float(self._errors(chosen).mean())))
        path.reverse()
        return path[first_as_good([self._errors(chosen) for chosen in path])]

    def _is_inseparable(self, k: int, chosen: Sequence[int]) -> bool:
        """Whether the chosen orders already explain an order."""
        if not isinstance(self._terms[k], OrderTerm):
            return False
        others = [c for c in chosen if isinstance(self._terms[c], OrderTerm)]
        for group in [*([c] for c in others), others] if others else []:
            if self._unexplained(k, group) < _APART:
                self.inseparable[self._terms[k].name] = self._terms[group[0]].name
                return True
        return False

    def _unexplained(self, k: int, others: Sequence[int]) -> float:
        """Share of the variance of a term's columns that others leave, at the least."""
        total, mine, theirs = self._equations.products[0], self._places[k], self._columns(others)
        cross = total[np.ix_(theirs, mine)]
        explained = cross.T @ np.linalg.lstsq(total[np.ix_(theirs, theirs)], cross, rcond=1e-10)[0]
        own = total[np.ix_(mine, mine)]
        left = np.linalg.pinv(own, rcond=1e-12, hermitian=True) @ (own - explained)
        return float(np.linalg.eigvals(left).real.min())

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Uncertainties by the Guide to the Expression of Uncertainty in Measurement (JCGM 100:2008)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Self

import numpy as np
from numpy.typing import NDArray

Values = Sequence[float] | NDArray[np.float64]

COVERAGE = 0.95  #: coverage probability of expanded uncertainties
_NORMAL = 1.959963984540054  # Student's quantile for infinitely many degrees of freedom
_FEWEST = 3  # groups of blocks from which a standard error is estimated
_ROUNDING = 1e-15  # rad
_MAX_DEGREES = 10_000  # of freedom; the quantile is within 1.3e-4 of the normal one


@dataclass(frozen=True, slots=True)
class Component:
    """One source of uncertainty."""

    standard: float  #: its contribution to the standard uncertainty of the value
    degrees_of_freedom: float = math.inf


@dataclass(frozen=True, slots=True)
class Estimate:
    """A measured quantity."""

    value: float
    standard: float | None  #: standard uncertainty, in the unit of the value; None without repeats
    degrees_of_freedom: float  #: effective degrees of freedom of the standard uncertainty
    repeats: int

    @classmethod
    def of_mean(cls, values: Values, *others: Component) -> Self:
        """Estimate a quantity from at least one repeat, and components common to all repeats."""
        return cls.of_sum([(1.0, values)], *others)

    @classmethod
    def of_sum(cls, terms: Sequence[tuple[float, Values]], *others: Component) -> Self:
        """Estimate a sum of quantities, each with a factor and its own repeats, at least one.

        The standard uncertainties of the means (GUM 4.2.3) and the other components are combined
        (GUM 5.1.2), with effective degrees of freedom by Welch and Satterthwaite (GUM G.4.1).
        """
        value = sum(factor * float(np.mean(values)) for factor, values in terms)
        repeats = min(len(values) for _, values in terms)
        if repeats == 1:
            return cls(value, None, 0.0, 1)
        own = [
            Component(abs(factor) * deviation(values) / math.sqrt(len(values)), len(values) - 1)
            for factor, values in terms
        ]
        return cls(value, *combined((*own, *others)), repeats)

    @property
    def uncertainty(self) -> float | None:
        """Expanded uncertainty, by Student's t for `COVERAGE` (GUM G.3)."""
        if not self.standard:
            return self.standard
        # Rounding errors must not cost a whole degree of freedom.
        degrees = int(min(self.degrees_of_freedom, _MAX_DEGREES) + 1e-6)
        return student_t(degrees) * self.standard if degrees else math.inf

    @property
    def expanded(self) -> float:
        """Expanded uncertainty for a decision: infinite where it is not known."""
        return math.inf if self.uncertainty is None else self.uncertainty

    @property
    def ends(self) -> tuple[float, float]:
        """Ends of the interval of the expanded uncertainty; infinite where that is not known."""
        return self.value - self.expanded, self.value + self.expanded

    @property
    def clear(self) -> bool:
        """Whether the expanded uncertainty is known and does not exceed the value."""
        return self.expanded <= abs(self.value)

    def inverse(self) -> 'Estimate':
        """Estimate the reciprocal of the quantity."""
        value = 1.0 / self.value
        standard = None if self.standard is None else value * value * self.standard
        return Estimate(value, standard, self.degrees_of_freedom, self.repeats)


def combined(parts: Sequence[Component]) -> tuple[float, float]:
    """Combine independent components (GUM 5.1.2).

    The standard uncertainty is returned with its effective degrees of freedom (GUM G.4.1).
    """
    standard = math.hypot(*(part.standard for part in parts))
    # Shares of the variance, since fourth powers of large numbers overflow.
    spread = sum(
        (part.standard / standard) ** 4 / part.degrees_of_freedom for part in parts if standard
    )
    return standard, 1.0 / spread if spread else math.inf


def deviation(values: Values) -> float:
    """Experimental standard deviation (GUM 4.2.2), without squares that overflow."""
    return math.hypot(*(np.asarray(values) - np.mean(values))) / math.sqrt(len(values) - 1)


def standard_error(
    values: NDArray[np.float64], together: Sequence[int] = (1,)
) -> tuple[float, int]:
    """Standard error of the mean of blocks in the order of time, and its degrees of freedom.

    As neighbours may be correlated, it is the greatest of the errors from groups of `together`
    neighbours. These need at least three groups, or two single blocks; the error is 0 otherwise.
    """
    errors = [(0.0, 1)]
    for size in together:
        count = len(values) // size
        if count >= (_FEWEST if size > 1 else 2):
            means: Values = values
            if size > 1:
                means = [
                    float(group.sum()) / len(group) for group in np.array_split(values, count)
                ]
            errors.append((deviation(means) / math.sqrt(count), count - 1))
    return max(errors)


def jackknife(fits: Values, *others: Component, together: Sequence[int] = (1,)) -> Estimate:
    """Estimate a quantity from the scatter of Tukey's pseudo-values.

    (B. Efron, C. Stein, Annals of Statistics 9 (1981) 586)

    Args:
        fits: the fit to all blocks, which is the value, and then those without each block,
            (1 + blocks,).
        others: further components of the uncertainty.
        together: numbers of neighbouring blocks that `standard_error` takes as one.
    """
    whole, without = float(fits[0]), np.asarray(fits[1:])
    if len(without) <= 1:
        return Estimate(whole, None, 0.0, 1)
    pseudo_values = len(without) * whole - (len(without) - 1) * without
    scatter = Component(*standard_error(pseudo_values, together))
    return Estimate(whole, *combined((scatter, *others)), len(without))


def resolution(step: float) -> float:
    """Standard uncertainty of a reading in steps (GUM F.2.2.1), in their unit."""
    return step / math.sqrt(12.0)


@cache
def student_t(degrees: int) -> float:
    """Quantile t of Student's distribution: the coverage lies within ±t.

    Args:
        degrees: of freedom, at least 1; 10 000 and more count as infinitely many.
    """
    if degrees >= _MAX_DEGREES:
        return _NORMAL
    density = math.exp(math.lgamma(0.5 * (degrees + 1)) - math.lgamma(0.5 * degrees))
    density *= 2.0 / math.sqrt(math.pi)  # of the angle at 0
    angle, step = math.atan(_NORMAL / math.sqrt(degrees)), 1.0
    while step > _ROUNDING:  # Newton's steps rise to the angle, as the density falls with it
        step = (COVERAGE - _share_within(angle, degrees)) / density
        step /= math.cos(angle) ** (degrees - 1)
        angle += step
    return math.sqrt(degrees) * math.tan(angle)


def _share_within(angle: float, degrees: int) -> float:
    """Share of the distribution within ±t, with t = sqrt(degrees) tan(angle).

    Abramowitz and Stegun, Handbook of Mathematical Functions, eqs. 26.7.3 and 26.7.4.
    """
    sine, cosine = math.sin(angle), math.cos(angle)
    odd = degrees % 2
    total, term = 0.0, cosine if odd else 1.0
    for k in range(2 + odd, degrees + 1, 2):
        total += term
        term *= cosine * cosine * (k - 1) / k
    return 2.0 / math.pi * (angle + sine * total) if odd else sine * total

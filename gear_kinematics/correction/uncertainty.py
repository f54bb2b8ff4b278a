"""Uncertainties by the Guide to the Expression of Uncertainty in Measurement (JCGM 100:2008)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Self

import numpy as np
from numpy.typing import NDArray

COVERAGE = 0.95
"""Coverage probability of expanded uncertainties."""
_NORMAL = 1.959963984540054
"""The quantile of Student's distribution for infinitely many degrees of freedom."""
_MANY = 10_000
_EXACT = 1e-6
"""Least standard uncertainty of an effect in usual effects."""


@dataclass(frozen=True, slots=True)
class Component:
    """One source of uncertainty."""

    standard: float
    """Its contribution to the standard uncertainty of the value."""
    degrees_of_freedom: float = math.inf


@dataclass(frozen=True, slots=True)
class Estimate:
    """A measured quantity."""

    value: float
    standard: float | None
    """Standard uncertainty, in the unit of the value; None without repeats."""
    degrees_of_freedom: float
    """Effective degrees of freedom of the standard uncertainty."""
    repeats: int

    @classmethod
    def of_mean(cls, values: Sequence[float], *others: Component) -> Self:
        """Estimate a quantity from its repeats, and components that are the same in all of them.

        Args:
            values: at least one.
            others: such as the resolution of the encoder.
        """
        return cls.of_sum([(1.0, values)], *others)

    @classmethod
    def of_sum(cls, terms: Sequence[tuple[float, Sequence[float]]], *others: Component) -> Self:
        """Estimate a sum of quantities, each with its own repeats.

        The standard uncertainties of the means (GUM 4.2.3) and the other components are combined
        (GUM 5.1.2), with effective degrees of freedom by Welch and Satterthwaite (GUM G.4.1).

        Args:
            terms: factor and repeated values of each quantity, at least one value each.
            others: further components of the sum.
        """
        value = sum(factor * float(np.mean(values)) for factor, values in terms)
        repeats = min(len(values) for _, values in terms)
        if repeats == 1:
            return cls(value, None, 0.0, 1)
        own = [
            Component(
                abs(factor) * _deviation(values) / math.sqrt(len(values)),
                len(values) - 1,
            )
            for factor, values in terms
        ]
        return cls(value, *combined((*own, *others)), repeats)

    @property
    def uncertainty(self) -> float | None:
        """Expanded uncertainty, by Student's t for `COVERAGE` (GUM G.3)."""
        if self.standard is None:
            return None
        return student_t(_whole(self.degrees_of_freedom)) * self.standard

    @property
    def clear(self) -> bool:
        """Whether the expanded uncertainty, if known, does not exceed the value."""
        return (self.uncertainty or 0.0) <= abs(self.value)

    def minus(self, other: 'Estimate') -> 'Estimate':
        """Estimate the difference from a quantity that was measured independently.

        Its degrees of freedom are those of Welch and Satterthwaite (GUM G.4.1).
        """
        value, repeats = self.value - other.value, min(self.repeats, other.repeats)
        if self.standard is None or other.standard is None:
            return Estimate(value, None, 0.0, repeats)
        parts = [
            Component(estimate.standard, estimate.degrees_of_freedom)
            for estimate in (self, other)
            if estimate.standard is not None
        ]
        return Estimate(value, *combined(parts), repeats)

    def joined(self, *others: Component) -> 'Estimate':
        """Add components of uncertainty that the repeats do not show (GUM 5.1.2)."""
        if self.standard is None:
            return self
        own = Component(self.standard, self.degrees_of_freedom)
        return Estimate(self.value, *combined((own, *others)), self.repeats)

    def times(self, factor: float) -> 'Estimate':
        """Estimate a multiple of the quantity."""
        standard = None if self.standard is None else abs(factor) * self.standard
        return Estimate(factor * self.value, standard, self.degrees_of_freedom, self.repeats)

    def probability_of_zero(self) -> float | None:
        """Probability of a value as far from zero if the quantity is zero; None if unknown."""
        if self.standard is None:
            return None
        if not self.standard:
            return float(self.value == 0.0)
        return student_tail(self.value / self.standard, self.degrees_of_freedom)

    def inverse(self) -> 'Estimate':
        """Estimate the reciprocal of the quantity."""
        value = 1.0 / self.value
        standard = None if self.standard is None else value * value * self.standard
        return Estimate(value, standard, self.degrees_of_freedom, self.repeats)


def combined(parts: Sequence[Component]) -> tuple[float, float]:
    """Combine independent components (GUM 5.1.2).

    Returns:
        The standard uncertainty, and its effective degrees of freedom (GUM G.4.1).
    """
    standard = math.hypot(*(part.standard for part in parts))
    # Shares of the variance, since fourth powers of large numbers overflow.
    spread = sum(
        (part.standard / standard) ** 4 / part.degrees_of_freedom for part in parts if standard
    )
    return standard, 1.0 / spread if spread else math.inf


def _whole(degrees: float) -> int:
    """Round degrees of freedom down."""
    # Rounding must not cost a whole degree of freedom.
    return int(min(degrees, _MANY) + 1e-6)


def _deviation(values: Sequence[float]) -> float:
    """Experimental standard deviation (GUM 4.2.2), without squares that overflow."""
    return math.hypot(*(np.asarray(values) - np.mean(values))) / math.sqrt(len(values) - 1)


def resolution(step: float) -> float:
    """Standard uncertainty of a reading in steps (GUM F.2.2.1), in their unit."""
    return step / math.sqrt(12.0)


def hidden_resolution(step: float, repeats: Sequence[float], readings: int) -> float:
    """Standard uncertainty by the steps of an encoder that the scatter of repeats does not show.

    Repeats that scatter over steps are rounded differently. With normal scatter of the standard
    deviation s, exp(-2π²(s/step)²) is the most that remains in their mean: B. Widrow, I. Kollár,
    M.-C. Liu, IEEE Trans. Instrum. Meas. 45 (1996) 353.

    Args:
        step: of a reading.
        repeats: at least one, each a sum or difference of readings.
        readings: their number in each repeat.
    """
    if not step or len(repeats) == 1:
        return math.sqrt(readings) * resolution(step)
    turns = math.pi * _deviation(repeats) / math.sqrt(readings) / step
    return math.sqrt(readings) * resolution(step) * math.exp(-2.0 * turns * turns)


def slope_resolution(step: float, run: float, slope: float) -> float:
    """Standard uncertainty of a slope by the steps of an encoder.

    The line goes through many readings, of which those within a step count as one; over less than
    six steps, the line counts as one through its ends.

    Args:
        step: of a reading.
        run: length of the line on the other axis.
        slope: of the line, in the unit of the step over that of the run.
    """
    if not step:
        return 0.0
    steps = max(6.0, abs(slope) * run / step)
    return resolution(step) / run * math.sqrt(12.0 / steps)


def by_steps(standard: float, repeats: int) -> Component:
    """Give what the steps of an encoder add to the uncertainty of a mean over repeats.

    It is no better known than what chance does to the mean.

    Args:
        standard: uncertainty by the steps.
        repeats: number of the values whose mean is taken.
    """
    return Component(standard, repeats - 1)


def common_part(errors: NDArray[np.float64]) -> float:
    """Root mean square of what is the same in all repeats, without what scatter adds to it.

    Args:
        errors: (repeats, ...); a single repeat shows nothing.
    """
    count = len(errors)
    if count < 2:  # noqa: PLR2004, nothing to compare
        return 0.0
    scatter = float(np.mean(np.var(errors, axis=0, ddof=1))) / count
    return math.sqrt(max(0.0, float(np.mean(np.mean(errors, axis=0) ** 2)) - scatter))


@cache
def student_t(degrees: int) -> float:
    """Quantile t of Student's distribution: the coverage lies within ±t.

    Args:
        degrees: of freedom, at least 1; 10 000 and more count as infinitely many.
    """
    if degrees >= _MANY:
        return _NORMAL
    low, high = 0.0, 0.5 * math.pi
    while True:
        middle = 0.5 * (low + high)
        if middle in {low, high}:
            return math.sqrt(degrees) * math.tan(middle)
        if _share_within(middle, degrees) < COVERAGE:
            low = middle
        else:
            high = middle


def student_tail(t: float, degrees: float) -> float:
    """Probability that Student's distribution exceeds t in magnitude.

    Args:
        t: of either sign.
        degrees: of freedom, at least 1; fractions are rounded down.
    """
    whole = _whole(degrees)
    if whole >= _MANY:
        return math.erfc(abs(t) / math.sqrt(2.0))
    return max(0.0, 1.0 - _share_within(math.atan(abs(t) / math.sqrt(whole)), whole))


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

"""Since when a gear has changed: steps and slopes in figures of recordings in order of time."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.lost_motion.several.common import Quantity
from gear_kinematics.lost_motion.several.comparison import SIGNIFICANCE, holm
from gear_kinematics.state.uncertainty import Estimate

Array = NDArray[np.float64]

FEWEST = 4
"""Recordings in which a change can be told from scatter."""
_DRAWS = 4000
"""Simulated sequences of an unchanged gear."""
_SPREADS = (0.0, 1.0, 100.0)
"""Simulated scatter between recordings / median scatter within them."""
_PRIOR = 4.0
"""Degrees of freedom of the common scatter, to which the scatter of each recording is drawn."""
_PLAUSIBLE = 3.84
"""Loss of the sum of squares up to which another place of a step is plausible (95 %)."""
_SEED = 0x6EA2


@dataclass(frozen=True, slots=True)
class Step:
    """A figure changes between two recordings and is constant before and after."""

    since: int
    """Number of the first recording after it, in order of time."""
    earliest: int
    latest: int
    """Range of `since`, with a probability of 95 %."""
    change: Estimate


@dataclass(frozen=True, slots=True)
class Slope:
    """A figure changes in proportion to time."""

    per_day: Estimate
    change: Estimate
    """Over all the recordings."""


@dataclass(frozen=True, eq=False, slots=True)
class Trend:
    """Changes of one figure over time."""

    quantity: Quantity
    numbers: tuple[int, ...]
    """Of the recordings with this figure and its uncertainty, in order of time."""
    probability: float
    """Of a false alarm: that an unchanged gear shows as much."""
    fitted: Array
    """(n,), the figure without its scatter, SI."""
    steps: tuple[Step, ...] = ()
    """In order of time, if the probability is small for all figures together."""
    slope: Slope | None = None

    @property
    def changed(self) -> bool:
        """Whether the figure has changed."""
        return bool(self.steps or self.slope)


@dataclass(frozen=True, eq=False, slots=True)
class _Sequence:
    """A figure in order of time."""

    time: Array
    """(n,), days."""
    value: Array
    """(n,), in units of the median standard uncertainty."""
    variance: Array
    """(n,), of the scatter within the recordings, likewise."""
    degrees: Array
    """(n,), of freedom of the variances."""

    def part(self, first: int, last: int) -> '_Sequence':
        rows = slice(first, last)
        parts = (self.time, self.value, self.variance, self.degrees)
        return _Sequence(*(values[rows] for values in parts))


def trends(quantities: Sequence[Quantity], days: Sequence[float]) -> list[Trend]:
    """Find the changes of figures over time.

    An unchanged gear is taken to scatter within its recordings, as their uncertainties say, and
    between them by any amount. Probabilities of false alarms come from simulated sequences.

    Args:
        quantities: with values in order of time.
        days: times of the recordings, ascending.
    """
    found = []
    for quantity in quantities:
        numbers = tuple(k for k, v in enumerate(quantity.values) if v and v.standard)
        if len(numbers) < FEWEST:
            continue
        sequence, scale = _sequence(quantity, numbers, days)
        probability, _ = _test(sequence)
        found.append((quantity, numbers, sequence, scale, probability))
    together = holm([probability for *_, probability in found])
    return [
        _trend(quantity, numbers, sequence, scale, probability, changed=adjusted < SIGNIFICANCE)
        for (quantity, numbers, sequence, scale, probability), adjusted in zip(
            found, together, strict=True
        )
    ]


def _sequence(
    quantity: Quantity, numbers: Sequence[int], days: Sequence[float]
) -> tuple[_Sequence, float]:
    """Return a figure in order of time, and the unit of its values."""
    estimates = [value for k in numbers if (value := quantity.values[k])]
    own = np.array([found.standard or 0.0 for found in estimates])
    scale = float(np.median(own))
    values = np.array([found.value for found in estimates])
    degrees = np.array([found.degrees_of_freedom for found in estimates])
    return (
        _Sequence(
            np.array([days[k] for k in numbers]),
            (values - values.mean()) / scale,
            (own / scale) ** 2,
            degrees,
        ),
        scale,
    )


def _trend(
    quantity: Quantity,
    numbers: tuple[int, ...],
    sequence: _Sequence,
    scale: float,
    probability: float,
    *,
    changed: bool,
) -> Trend:
    mean = float(np.mean([v.value for k in numbers if (v := quantity.values[k])]))
    count = len(numbers)
    edges, sloping = _divided(sequence) if changed else ([], False)
    design = _design(sequence, edges, sloping=sloping)
    weight = 1.0 / _moderate(sequence.variance, sequence.degrees)
    covariance = np.linalg.inv(design.T @ (weight[:, None] * design))
    factors = covariance @ design.T @ (weight * sequence.value)
    rest = sequence.value - design @ factors
    free = count - design.shape[1]
    # More scatter than within the recordings is scatter between them.
    covariance *= max(1.0, float(np.sum(weight * rest**2)) / free)

    def estimate(factor: Array) -> Estimate:
        variance = float(factor @ covariance @ factor)
        return Estimate(scale * float(factor @ factors), scale * variance**0.5, float(free), count)

    unit = np.eye(design.shape[1])
    fitted = mean + scale * (design @ factors)
    trend = Trend(quantity, numbers, probability, fitted)
    if sloping:
        span = float(np.ptp(sequence.time))
        change = estimate(unit[1])
        return replace(trend, slope=Slope(change.times(1.0 / span), change))
    bounds = [0, *edges, count]

    def step(k: int, edge: int) -> Step:
        earliest, latest = _places(sequence, bounds[k], bounds[k + 2], edge)
        change = estimate(unit[k + 1] - unit[k])
        return Step(numbers[edge], numbers[earliest], numbers[latest], change)

    return replace(trend, steps=tuple(step(k, edge) for k, edge in enumerate(edges)))


def _design(sequence: _Sequence, edges: Sequence[int], *, sloping: bool) -> Array:
    """Columns of the fit: the mean and the slope, or a mean for each part."""
    count = len(sequence.time)
    if sloping:
        return np.stack([np.ones(count), _relative(sequence.time)], axis=1)
    part = np.searchsorted(edges, np.arange(count), side='right')
    columns: Array = (part[:, None] == np.arange(len(edges) + 1)).astype(np.float64)
    return columns


def _divided(sequence: _Sequence) -> tuple[list[int], bool]:
    """Divide a changed sequence at its steps, until its parts do not change any more.

    Returns:
        The first rows after the steps, and whether it has a slope instead.
    """
    _, best = _test(sequence)
    count = len(sequence.value)
    if best == count - 1:
        return [], True
    edges, pending = [], [(0, count, best + 1)]
    while pending:
        first, last, edge = pending.pop()
        edges.append(edge)
        for low, high in ((first, edge), (edge, last)):
            if high - low < FEWEST:
                continue
            probability, place = _test(sequence.part(low, high))
            if probability < SIGNIFICANCE and place < high - low - 1:
                pending.append((low, high, low + place + 1))
    return sorted(edges), False


def _places(sequence: _Sequence, first: int, last: int, edge: int) -> tuple[int, int]:
    """Range of rows at which a step between two other steps is about as plausible."""
    part = sequence.part(first, last)
    variance = _moderate(part.variance, part.degrees)
    gains, rest = _gains(part.value[None], variance[None], _steps(last - first))
    least = gains[0, edge - first - 1] - _PLAUSIBLE * max(1.0, float(rest[0]))
    places = np.flatnonzero(gains[0] >= least) + first + 1
    return int(places[0]), int(places[-1])


def _test(sequence: _Sequence) -> tuple[float, int]:
    """Test whether a sequence changes.

    Returns:
        The probability that an unchanged gear shows as much, and the number of the best of the
        candidates: steps after each row but the last, then a slope.
    """
    candidates = np.concatenate(
        [_steps(len(sequence.time)), _relative(sequence.time)[:, None]], axis=1
    )
    observed = _moderate(sequence.variance, sequence.degrees)
    gain, best = _greatest(sequence.value[None], observed[None], candidates)
    random = np.random.default_rng(_SEED)
    shape = (_DRAWS, len(sequence.value))
    degrees = np.minimum(sequence.degrees, 1e6)
    probability = 0.0
    for spread in _SPREADS:
        variance = observed * random.chisquare(degrees, shape) / degrees
        value = random.standard_normal(shape) * np.sqrt(observed + spread**2)
        gains, _ = _greatest(value, _moderate(variance, degrees), candidates)
        exceeding = (1 + np.count_nonzero(gains >= gain[0])) / (1 + _DRAWS)
        probability = max(probability, float(exceeding))
    return probability, int(best[0])


def _greatest(value: Array, variance: Array, candidates: Array) -> tuple[Array, NDArray[np.intp]]:
    """Greatest gain of a candidate, over the scatter that it leaves, and which one it is."""
    gains, rest = _gains(value, variance, candidates)
    best = np.argmax(gains, axis=1)
    return gains.max(axis=1) / np.maximum(1.0, rest), best


def _gains(value: Array, variance: Array, candidates: Array) -> tuple[Array, Array]:
    """By how much each candidate beside the mean reduces the weighted sum of squares.

    Args:
        value: (m, n), m sequences.
        variance: (m, n).
        candidates: (n, c).

    Returns:
        Gains, (m, c), and the sum of squares per degree of freedom that the best leaves, (m,).
    """
    weight = 1.0 / variance
    total = weight.sum(axis=1, keepdims=True)
    value = value - (weight * value).sum(axis=1, keepdims=True) / total
    spread = weight @ candidates**2 - (weight @ candidates) ** 2 / total
    common = (weight * value) @ candidates
    gains = np.divide(common**2, spread, out=np.zeros_like(common), where=spread > 0.0)
    free = value.shape[1] - 2
    rest = ((weight * value**2).sum(axis=1) - gains.max(axis=1)) / free
    return gains, rest


def _moderate(variance: Array, degrees: Array) -> Array:
    """Draw variances of few degrees of freedom towards their median.

    G. K. Smyth, Statistical Applications in Genetics and Molecular Biology 3 (2004) 3, eq. 1.
    """
    common = np.median(variance, axis=-1, keepdims=True)
    own = np.minimum(degrees, 1e6)
    moderated: Array = (_PRIOR * common + own * variance) / (_PRIOR + own)
    return moderated


def _steps(count: int) -> Array:
    """Candidates: a step after each row but the last, (count, count - 1)."""
    return np.tri(count, count - 1, -1)


def _relative(time: Array) -> Array:
    """Times from 0 at the first to 1 at the last; all 0 if they are the same."""
    span = float(np.ptp(time))
    return (time - time[0]) / span if span else np.zeros_like(time)

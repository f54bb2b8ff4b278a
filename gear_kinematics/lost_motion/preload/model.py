"""Play, friction and stiffness over the setting of the preload, from several recordings.

The model is that of `kinematics.preload`. At the setting x, with b = dplay/dx (zk/zs for a turn of
the ring gear in rad) and x0, at which the play is used up:

    interference = b (x - x0)                play = max(-interference, 0)
    limit = interference / c                 c: compliance of the softer branch alone
    friction = F0 + f max(x - x0, 0)

Both branches stay in mesh under a load M from x0 + M c/b on. Recordings scatter by more than the
repeats within them: every ± comes from their residuals about the model, of which there have to be
more than parameters. Otherwise there are only bounds.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.state.uncertainty import COVERAGE, Component, Estimate, combined, student_t

Array = NDArray[np.float64]

_MOST_FREEDOM = 1e6
"""Counts as infinitely many degrees of freedom."""


def coverage_factor(degrees_of_freedom: float) -> float:
    """Student's t for degrees of freedom of at least 1, which are rounded down from 2 on.

    Between 1 and 2, where that would triple it, its logarithm is about a straight line over the
    reciprocal.
    """
    if degrees_of_freedom >= 2.0:  # noqa: PLR2004, as the text says
        return student_t(int(min(degrees_of_freedom, _MOST_FREEDOM) + 1e-6))
    share = 2.0 / degrees_of_freedom - 1.0
    return student_t(2) * math.exp(share * math.log(student_t(1) / student_t(2)))


@dataclass(frozen=True, slots=True)
class Reading:
    """Figures of a recording at one setting."""

    name: str
    setting: float
    """A number, or the turn of the ring gear, rad."""
    play: Estimate | None
    """rad; None where zero is within reach, or where it is unknown."""
    limit: float | None
    """rad, upper bound of a play that is not given."""
    friction: Estimate | None
    """N·m."""
    positive: Estimate | None
    """N·m/rad, stiffness under positive torque, clear of the play."""
    negative: Estimate | None


@dataclass(frozen=True, slots=True)
class Span:
    """A setting, and the interval that contains it with a probability of 95 %."""

    value: float
    low: float
    high: float

    @property
    def vague(self) -> bool:
        """Whether the interval is so wide that only its lower end tells something."""
        return self.high - self.low > 2.0 * self.value


@dataclass(frozen=True, slots=True)
class PlayLine:
    """Play = offset - slope × setting, where there is play."""

    offset: float
    """rad."""
    slope: float
    """rad per unit of the setting."""
    covariance: tuple[float, float, float]
    """Of offset and slope: variance, covariance, variance."""
    scatter: float
    """rad, standard deviation of a recording about the line."""
    degrees_of_freedom: float

    @property
    def end(self) -> float:
        """The setting x0 at which the play is used up."""
        return self.offset / self.slope

    def variance(self, setting: float) -> float:
        """Variance of the line, rad²."""
        offset, both, slope = self.covariance
        return offset - 2.0 * setting * both + setting * setting * slope

    def closes(self, twist: Estimate) -> Span | None:
        """Find the setting with an interference of `twist`, rad, by Fieller's theorem.

        E. C. Fieller, J. Royal Statistical Society B 16 (1954) 175.

        Returns:
            None if the interval is unbounded, as the slope may be zero.
        """
        reach = self.offset + twist.value
        value = reach / self.slope
        own = Component(math.sqrt(max(self.variance(value), 0.0)), self.degrees_of_freedom)
        other = Component(twist.standard or 0.0, twist.degrees_of_freedom or math.inf)
        _, freedom = combined((own, other))
        factor = coverage_factor(freedom) ** 2
        offset, both, slope = self.covariance
        square = self.slope**2 - factor * slope
        if square <= 0.0:
            return None
        middle = (reach * self.slope - factor * both) / square
        rest = (reach**2 - factor * (offset + other.standard**2)) / square
        half = math.sqrt(max(middle**2 - rest, 0.0))
        return Span(value, middle - half, middle + half)


@dataclass(frozen=True, slots=True)
class Line:
    """A figure = base + slope × preloading, by least squares."""

    base: float
    slope: float | None
    """Per unit of the setting; None if no recording is preloaded."""
    covariance: tuple[float, float, float]
    scatter: float
    degrees_of_freedom: float
    by_end: tuple[float, float] = (0.0, 0.0)
    """Derivatives of base and slope to the setting x0."""

    def predict(self, preloading: float, end: Component) -> Estimate | None:
        """Predict the figure of a further recording.

        Args:
            preloading: how far its setting is beyond the play.
            end: uncertainty of the setting x0.
        """
        if preloading and self.slope is None:
            return None
        gradient = self.slope or 0.0
        base, both, slope = self.covariance
        own = base + 2.0 * preloading * both + preloading**2 * slope
        moved = self.by_end[0] + preloading * self.by_end[1]
        if preloading:
            moved -= gradient  # x0 further up preloads less
        parts = (
            Component(math.sqrt(max(own, 0.0) + self.scatter**2), self.degrees_of_freedom),
            Component(abs(moved) * end.standard, end.degrees_of_freedom),
        )
        return Estimate(self.base + preloading * gradient, *combined(parts), 2)


def regression(regressor: Array, values: Array) -> Line | None:
    """Fit values = base + slope × regressor, or a constant where the regressor is 0.

    Returns:
        None without residuals.
    """
    if len(values) > 1 and not np.any(regressor):
        scatter = float(np.std(values, ddof=1))
        covariance = (scatter**2 / len(values), 0.0, 0.0)
        return Line(float(np.mean(values)), None, covariance, scatter, len(values) - 1)
    freedom = len(values) - 2
    centred = regressor - np.mean(regressor)
    square = float(centred @ centred)
    if freedom < 1 or not square:
        return None
    slope = float(centred @ values) / square
    base = float(np.mean(values) - slope * np.mean(regressor))
    rest = values - base - slope * regressor
    variance = float(rest @ rest) / freedom
    middle = float(np.mean(regressor))
    covariance = (
        variance * (1.0 / len(values) + middle * middle / square),
        -variance * middle / square,
        variance / square,
    )
    return Line(base, slope, covariance, math.sqrt(variance), freedom)


@dataclass(frozen=True, slots=True)
class Play:
    """What the plays at all settings tell."""

    line: PlayLine | None
    """None if it is not determined, or does not describe the plays."""
    greatest_with: float | None
    """The greatest setting below all without play."""
    least_without: float | None
    """The least setting from which on there is no play at any."""
    cause: str
    """Why there is no line, and what to record instead."""
    trend: PlayLine | None = None
    """A line from which plays can be predicted, whether or not it tells where they end."""


def settled(readings: Sequence[Reading]) -> list[Reading]:
    """Take a play beyond a setting without play as chance, where it is likely among so many."""
    without = [r.setting for r in readings if r.play is None and r.limit is not None]
    first = min(without, default=math.inf)
    return [
        _without_play(r) if r.setting >= first and _by_chance(r, len(readings)) else r
        for r in readings
    ]


def _by_chance(reading: Reading, count: int) -> bool:
    probability = reading.play.probability_of_zero() if reading.play else None
    return probability is not None and probability > (1.0 - COVERAGE) / count


def _without_play(reading: Reading) -> Reading:
    play = reading.play
    limit = play.value + (play.uncertainty or 0.0) if play else reading.limit
    return replace(reading, play=None, limit=limit)


def play_over(readings: Sequence[Reading], scale: float | None) -> Play:
    """Fit the plays of readings.

    Args:
        readings: at three settings or more.
        scale: rad of play per unit of the setting; None: unknown.
    """
    with_play = [r.setting for r in readings if r.play is not None]
    without = [r.setting for r in readings if r.play is None and r.limit is not None]
    first = min(without, default=math.inf)
    last = max(with_play, default=-math.inf)
    bounds = (
        max((x for x in with_play if x < first), default=None),
        min((x for x in without if x > last), default=None),
    )
    if not with_play:
        cause = 'no setting shows play; record one with less preload'
        return Play(None, *bounds, cause if without else 'no play is known; repeat the ramps')
    if last >= first:
        return Play(
            None,
            *bounds,
            'there is play at a greater setting than one without: the play does not fall with the '
            'setting; record the settings again',
        )
    least = 1 if scale else 2
    active = [r for r in readings if r.play is not None]
    if len(active) <= least:
        return Play(
            None,
            *bounds,
            f'{len(active)} recording{"s show" if len(active) > 1 else " shows"} play, and at '
            f'least {least + 1} are needed for a ±; record more settings with play, or repeat '
            'those',
        )
    line = _known_slope(active, scale) if scale else _free_slope(active)
    if line is None or line.slope <= 0.0:
        return Play(None, *bounds, 'the play does not fall with the setting')
    if line.closes(Estimate(0.0, 0.0, math.inf, 1)) is None:
        cause = 'the play falls by less than its scatter over these settings'
        return Play(None, *bounds, cause, line)
    if contradicting := [
        r.name
        for r in readings
        if r.play is None and r.limit is not None and _exceeds(line, r.setting, r.limit)
    ]:
        cause = f'the play of the others does not end before {contradicting[0]}, which has none'
        return Play(None, *bounds, cause)
    return Play(line, *bounds, '', line)


def _exceeds(line: PlayLine, setting: float, limit: float) -> bool:
    """Whether a line has more play than a recording can have."""
    spread = math.sqrt(line.variance(setting) + line.scatter**2)
    value = line.offset - line.slope * setting
    return value - coverage_factor(line.degrees_of_freedom) * spread > limit


def _known_slope(active: Sequence[Reading], scale: float) -> PlayLine:
    offsets = [r.play.value + scale * r.setting for r in active if r.play is not None]
    scatter = float(np.std(offsets, ddof=1))
    variance = scatter**2 / len(offsets)
    return PlayLine(
        float(np.mean(offsets)), scale, (variance, 0.0, 0.0), scatter, len(offsets) - 1
    )


def _free_slope(active: Sequence[Reading]) -> PlayLine | None:
    settings = np.array([r.setting for r in active])
    fitted = regression(settings, np.array([r.play.value for r in active if r.play]))
    if fitted is None or fitted.slope is None:
        return None
    base, both, slope = fitted.covariance
    return PlayLine(
        fitted.base,
        -fitted.slope,
        (base, -both, slope),
        fitted.scatter,
        fitted.degrees_of_freedom,
    )

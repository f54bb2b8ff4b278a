"""The least setting of the preload without play under a load, and what it costs in friction."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from gear_kinematics.kinematics.preload import Preload, Stiffness
from gear_kinematics.lost_motion.preload.model import (
    Array,
    Line,
    Play,
    Reading,
    Span,
    coverage_factor,
    play_over,
    regression,
    settled,
)
from gear_kinematics.state.uncertainty import Component, Estimate, combined, student_tail

FEWEST = 3
"""Settings that are needed."""
_LEVELS = 100
"""Torques of a range of stiffness."""
_STEPS = 30
"""Most iterations of the fitted compliance."""
_CLOSE = 1e-9
"""Relative change of the compliance at which they end."""
_MISFIT = 0.01
"""Probability below which a trend of the residuals is not taken for chance."""
_EXACT = Component(0.0)


@dataclass(frozen=True, slots=True)
class Branches:
    """Compliances of the branches alone, from recordings with play; rad/(N·m)."""

    positive: Estimate
    """Under positive torque."""
    negative: Estimate
    softer: Estimate
    """Of the softer one."""

    def preload(self, interference: float, factor: float = 1.0) -> Preload:
        """Return the model with an interference, rad, and with compliances times a factor."""
        branch_a, branch_b = (
            1.0 / (factor * side.value) for side in (self.negative, self.positive)
        )
        return Preload(Stiffness(branch_a, branch_b, math.inf), interference)


@dataclass(frozen=True, slots=True)
class Springs:
    """Stiffness over the setting by the model of both branches, fitted to all recordings."""

    branches: Branches
    factor: float
    """Of the compliances."""
    scatter: float
    """Relative standard deviation of a recording about the model."""
    recordings: int

    def at(self, interference: float, loads: tuple[float, float]) -> Estimate:
        """Predict the stiffness of a further recording over a range of load, N·m/rad."""
        value = 1.0 / _compliance(self.branches.preload(interference, self.factor), loads)
        spread = value * self.scatter * math.sqrt(1.0 + 1.0 / self.recordings)
        return Estimate(value, spread, self.recordings - 1, self.recordings)


@dataclass(frozen=True, slots=True)
class Advice:
    """What recordings at several settings tell about the preload."""

    readings: tuple[Reading, ...]
    scale: float | None
    """rad of play per unit of the setting, if known."""
    loads: tuple[float, float]
    """N·m, range of torque of the stiffness."""
    play: Play
    branches: Branches | None
    friction: Line | None
    """Over the setting beyond the play, or over all settings where the plays have no line."""
    springs: Springs | Line | None
    """By the model of both branches, or a straight line where the plays have none."""
    cause: str
    """Why there is no stiffness by the model."""

    def least(self, load: float) -> Span | None:
        """Find the least setting at which both branches stay in mesh under a load, N·m."""
        line = self.play.line
        if line is None:
            return None
        if load and self.branches is None:
            return None
        twist = Estimate(0.0, 0.0, math.inf, 1)
        if load and self.branches:
            twist = self.branches.softer.times(load)
            if twist.standard is None:
                return None
        return line.closes(twist)

    def price(self, load: float) -> Estimate | None:
        """Estimate the friction at the least setting less that without preload, N·m."""
        line, friction = self.play.line, self.friction
        if not load:
            return Estimate(0.0, 0.0, math.inf, 1) if line else None
        if not (line and friction and self.branches) or friction.slope is None:
            return None
        compliance = self.branches.softer
        preloading = load * compliance.value / line.slope
        price = friction.slope * preloading
        parts = (
            Component(preloading * math.sqrt(friction.covariance[2]), friction.degrees_of_freedom),
            Component(
                abs(price) * (compliance.standard or 0.0) / compliance.value,
                compliance.degrees_of_freedom or math.inf,
            ),
            Component(
                abs(price) * math.sqrt(line.covariance[2]) / line.slope, line.degrees_of_freedom
            ),
            Component(
                abs(preloading * friction.by_end[1]) * _end(self.play).standard,
                line.degrees_of_freedom,
            ),
        )
        return Estimate(price, *combined(parts), 2)

    def predicted_play(self, setting: float) -> Estimate | None:
        """Predict the play of a further recording, rad."""
        line = self.play.trend
        if line is None:
            return None
        spread = math.sqrt(line.variance(setting) + line.scatter**2)
        value = max(line.offset - line.slope * setting, 0.0)
        return Estimate(value, spread, line.degrees_of_freedom, 2)

    def predicted_friction(self, setting: float) -> Estimate | None:
        """Predict the friction of a further recording, N·m."""
        if self.friction is None:
            return None
        return self.friction.predict(_preloading(self.play, setting), _end(self.play))

    def predicted_stiffness(self, setting: float) -> Estimate | None:
        """Predict the stiffness of a further recording, N·m/rad."""
        match self.springs:
            case Springs() as springs if self.play.line:
                line = self.play.line
                return springs.at(line.slope * setting - line.offset, self.loads)
            case Line() as straight:
                return straight.predict(_preloading(self.play, setting), _EXACT)
        return None


def advise(readings: Sequence[Reading], scale: float | None, loads: tuple[float, float]) -> Advice:
    """Fit the model to recordings.

    Args:
        readings: at three settings or more.
        scale: rad of play per unit of the setting; None: estimated.
        loads: N·m, the range of torque of the stiffness.
    """
    readings = settled(readings)
    play = play_over(readings, scale)
    branches = _branches([r for r in readings if r.play is not None])
    springs, cause = _springs(readings, play, branches, loads)
    return Advice(
        tuple(readings), scale, loads, play, branches, _friction(readings, play), springs, cause
    )


def without(advice: Advice, setting: float) -> Advice | None:
    """Repeat the fit without a setting; None if too few are left."""
    kept = [reading for reading in advice.readings if reading.setting != setting]
    if len({reading.setting for reading in kept}) < FEWEST - 1:
        return None
    return advise(kept, advice.scale, advice.loads)


def _end(play: Play) -> Component:
    """Uncertainty of the setting at which the play is used up."""
    span = play.line and play.line.closes(Estimate(0.0, 0.0, math.inf, 1))
    if not (play.line and span):
        return _EXACT
    freedom = play.line.degrees_of_freedom
    return Component(0.5 * (span.high - span.low) / coverage_factor(freedom), freedom)


def _preloading(play: Play, setting: float) -> float:
    """How far a setting is beyond the play, or the setting itself where that is not known."""
    return max(setting - play.line.end, 0.0) if play.line else setting


def _friction(readings: Sequence[Reading], play: Play) -> Line | None:
    line = _over_preloading(readings, play, [r.friction for r in readings])
    if not (line and play.line):
        return line
    # The derivative to x0, by which the regressor shifts.
    change = 0.01 * max(abs(r.setting - play.line.end) for r in readings)
    shifted = replace(
        play, line=replace(play.line, offset=play.line.offset + change * play.line.slope)
    )
    other = _over_preloading(readings, shifted, [r.friction for r in readings])
    if other is None or other.slope is None or line.slope is None:
        return line
    by_end = ((other.base - line.base) / change, (other.slope - line.slope) / change)
    return replace(line, by_end=by_end)


def _over_preloading(
    readings: Sequence[Reading], play: Play, values: Sequence[Estimate | None]
) -> Line | None:
    known = [
        (_preloading(play, reading.setting), value.value)
        for reading, value in zip(readings, values, strict=True)
        if value
    ]
    if not known:
        return None
    regressor, found = (np.array(column) for column in zip(*known, strict=True))
    return regression(regressor, found)


def _branches(with_play: Sequence[Reading]) -> Branches | None:
    sides = []
    for values in ([r.positive for r in with_play], [r.negative for r in with_play]):
        known = [value.inverse() for value in values if value]
        if not known:
            return None
        sides.append(
            Estimate.of_mean([value.value for value in known]) if len(known) > 1 else known[0]
        )
    positive, negative = sides
    # Where both are equally soft, the greater estimate is within its ± as often as either.
    return Branches(positive, negative, max(sides, key=lambda side: side.value))


def _springs(
    readings: Sequence[Reading],
    play: Play,
    branches: Branches | None,
    loads: tuple[float, float],
) -> tuple[Springs | Line | None, str]:
    measured = [stiffness_of(reading) for reading in readings]
    if play.line is None or branches is None:
        return _over_preloading(readings, play, measured), ''
    if loads[0] >= loads[1]:
        return None, 'the friction takes up the torque of the ramps'
    known = [
        (play.line.slope * reading.setting - play.line.offset, 1.0 / value.value)
        for reading, value in zip(readings, measured, strict=True)
        if value
    ]
    if len(known) < FEWEST:
        return None, 'there is the stiffness of fewer than three recordings'
    interference, compliance = (np.array(column) for column in zip(*known, strict=True))
    factor = 1.0
    for _ in range(_STEPS):
        rest = _rest(branches, factor, interference, compliance, loads)
        factor *= math.exp(float(np.mean(rest)))
        if abs(float(np.mean(rest))) < _CLOSE:
            break
    rest = _rest(branches, factor, interference, compliance, loads)
    trend = regression(np.maximum(interference, 0.0), rest)
    if trend and trend.slope is not None and trend.covariance[2] > 0.0:
        t = trend.slope / math.sqrt(trend.covariance[2])
        if student_tail(t, trend.degrees_of_freedom) < _MISFIT:
            return None, (
                'over the preload the stiffness does not grow as that of two braced branches'
            )
    scatter = float(np.std(rest, ddof=1))
    return Springs(branches, factor, scatter, len(known)), ''


def _rest(
    branches: Branches,
    factor: float,
    interference: Array,
    compliance: Array,
    loads: tuple[float, float],
) -> Array:
    model = [_compliance(branches.preload(i, factor), loads) for i in interference.tolist()]
    rest: Array = np.log(compliance / np.array(model))
    return rest


def _compliance(preload: Preload, loads: tuple[float, float]) -> float:
    """Mean slope over a range of load of either sign, rad/(N·m)."""
    load = np.linspace(*loads, _LEVELS)
    about = load - np.mean(load)
    turns = [sign * preload.split(sign * load).output_turn for sign in (1.0, -1.0)]
    return float(np.mean([about @ turn for turn in turns]) / (about @ about))


def stiffness_of(reading: Reading) -> Estimate | None:
    """Stiffness of both signs of torque, N·m/rad; its uncertainty is not needed."""
    if not (reading.positive and reading.negative):
        return None
    mean = 0.5 * (1.0 / reading.positive.value + 1.0 / reading.negative.value)
    return Estimate(1.0 / mean, None, 0.0, 1)

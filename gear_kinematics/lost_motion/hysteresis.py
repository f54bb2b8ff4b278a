"""The figures of a hysteresis curve, by the definitions in docs/lost_motion.md.

The spring of the play model comes from the largest ramps, which load the gear; what moves at no
load comes from the smallest ones.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.lost_motion.ramps import Array, Branch, Loop, RampError, Ramps
from gear_kinematics.lost_motion.uncertainty import Component, Estimate, resolution

LOST_MOTION_SHARE = 0.03
"""Of the rated torque, to either side."""
STIFFNESS_SHARES = (0.15, 0.5)
"""Of the rated torque: where one range of stiffness ends and the next begins."""

_LEAST_RANGE = 1.5
"""A range of stiffness ends at as many times the torque where it begins, if not at a corner."""
_ROUNDING = 1e-11
"""Share of an angle that sums of many readings may be off by."""
_LEVELS = 200
"""Torques at which a curve is compared with a straight line or with the model."""
_FRICTIONS = 50
"""Values of the friction that are tried at first."""
_FINER, _REFINEMENTS = 11, 4
"""Values that are tried between those beside the best, and how often."""


@dataclass(frozen=True, slots=True)
class Stiffness:
    """Torsional stiffness over a range of torque, N·m/rad, on the ways away from zero."""

    low: float
    """N·m, either sign."""
    high: float
    """N·m."""
    both: Estimate
    positive: Estimate
    """Under positive torque alone."""
    negative: Estimate


@dataclass(frozen=True, slots=True)
class PlayModel:
    """Play and a spring in series, moved against Coulomb friction."""

    stiffness: float
    """N·m/rad, of the spring: that of the largest ramps in their highest range, clear of zero."""
    play: Estimate
    """rad: the backlash."""
    friction: Estimate
    """N·m, at the output."""
    residual: float
    """rad, root mean square of what the model leaves of the angle."""
    centre: float
    """rad, the angle in the middle of the play."""

    def loop(self, amplitude: float) -> tuple[Array, Array]:
        """The model's own hysteresis curve: torques and angles, from one peak round to it."""
        torque = amplitude * np.linspace(1.0, -1.0, _LEVELS)
        fall = _transmitted(torque, self.friction.value)
        load = np.concatenate([fall, -fall])
        angle = self.centre + load / self.stiffness + 0.5 * self.play.value * np.sign(load)
        return np.concatenate([torque, -torque]), angle


@dataclass(frozen=True, slots=True)
class Figures:
    """What the ramps of one amplitude tell."""

    amplitude: float
    """N·m."""
    loops: int
    hysteresis: Estimate
    """rad, the width of the curve at zero torque."""
    lost_motion: Estimate | None
    """rad, on the middle line between ± a share of the rated torque; None if they end before."""
    stiffness: tuple[Stiffness, ...]
    """In the ranges that they reach."""
    play_model: PlayModel | None = None
    """None where no range of stiffness is clear of zero, to know the spring by."""

    @property
    def play(self) -> Estimate | None:
        """rad, by the play model."""
        return self.play_model.play if self.play_model else None

    @property
    def friction(self) -> Estimate | None:
        """N·m, by the play model."""
        return self.play_model.friction if self.play_model else None


@dataclass(frozen=True, slots=True)
class Settings:
    """What figures refer to."""

    rated_torque: float
    """N·m."""
    corners: tuple[float, ...]
    """N·m, rising: between the ranges of stiffness."""
    angle_step: float
    """rad at the output, between readings of the encoder; 0 where it is not known."""


def figures(ramps: Sequence[Ramps], settings: Settings) -> tuple[Figures, ...]:
    """Measure the ramps, by amplitude from small to large.

    Raises:
        RampError: if the angle does not grow with the torque.
    """
    _check(ramps[-1], settings)
    stiffness = [_stiffness(group, settings) for group in ramps]
    # A range that begins at no torque has the play in it.
    clear = [found.both for found in stiffness[-1] if found.low > 0.0]
    spring = clear[-1] if clear else None
    return tuple(
        Figures(
            amplitude=group.amplitude,
            loops=len(group.loops),
            hysteresis=_hysteresis(group.loops, settings),
            lost_motion=_lost_motion(group.loops, settings),
            stiffness=found,
            play_model=_play_model(group.loops, spring, settings) if spring else None,
        )
        for group, found in zip(ramps, stiffness, strict=True)
    )


def _check(ramps: Ramps, settings: Settings) -> None:
    """Make sure that the torque moves the angle, and its own way."""
    ways = [loop.fall.angle[0] - loop.rise.angle[0] for loop in ramps.loops]
    if float(np.mean(ways)) <= _still(ramps, settings):
        raise RampError(
            'the angle does not grow with the torque. Does it stand still, or does one of them '
            'count backwards?'
        )


def _still(ramps: Ramps, settings: Settings) -> float:
    """How far an angle is from another that may be the same, rad."""
    angles = [branch.angle for loop in ramps.loops for branch in (loop.fall, loop.rise)]
    return max(settings.angle_step, _ROUNDING * float(np.max(np.abs(np.concatenate(angles)))))


def _hysteresis(loops: Sequence[Loop], settings: Settings) -> Estimate:
    reading = resolution(settings.angle_step)
    widths = [loop.width(0.0) for loop in loops]
    rounding = np.mean([loop.fall.rounding(0.0) - loop.rise.rounding(0.0) for loop in loops])
    return Estimate.of_mean(widths, Component(math.sqrt(2.0) * reading), _rounded(rounding))


def _rounded(rounding: float | np.floating) -> Component:
    """Between no rounding and all of it, rad, anything is as likely, GUM 4.3.7."""
    return Component(abs(float(rounding)) / math.sqrt(3.0))


def _lost_motion(loops: Sequence[Loop], settings: Settings) -> Estimate | None:
    torque = LOST_MOTION_SHARE * settings.rated_torque
    ways = [
        [branch for branch in branches if branch.reaches(torque) and branch.reaches(-torque)]
        for branches in ([loop.fall for loop in loops], [loop.rise for loop in loops])
    ]
    if not all(ways):
        return None
    angles = [[float(b.angle_at(torque) - b.angle_at(-torque)) for b in way] for way in ways]
    rounding = [np.mean([b.rounding(torque) - b.rounding(-torque) for b in way]) for way in ways]
    # Four readings, each by half.
    reading = Component(resolution(settings.angle_step))
    return Estimate.of_sum([(0.5, way) for way in angles], reading, _rounded(np.mean(rounding)))


# Stiffness


def _stiffness(ramps: Ramps, settings: Settings) -> tuple[Stiffness, ...]:
    corners = (0.0, *(corner for corner in settings.corners if corner < ramps.amplitude))
    found, still = [], _still(ramps, settings)
    for low, high in pairwise((*corners, ramps.amplitude)):
        if high < _LEAST_RANGE * low:
            break
        pulls = [
            [_compliance(branch, low, min(high, abs(branch.end))) for branch in pull]
            for pull in ramps.pulls
            if all(_loads(branch, low, ramps) for branch in pull)
        ]
        if pulls:
            positive, negative = zip(*pulls, strict=True)
            both = [0.5 * (a + b) for a, b in pulls]
            reading = Component(math.sqrt(2.0) * resolution(settings.angle_step) / (high - low))
            compliances = (both, positive, negative)
            if min(map(np.mean, compliances)) * (high - low) <= still:
                continue  # friction holds the gear all the way
            found.append(
                Stiffness(
                    low, high, *(Estimate.of_mean(c, reading).inverse() for c in compliances)
                )
            )
    return tuple(found)


def _loads(branch: Branch, low: float, ramps: Ramps) -> bool:
    """Whether a branch loads from a torque on as one of these ramps.

    One that comes from less does so beyond what it comes from: there the past is wiped out.
    """
    return abs(branch.start) < low or abs(branch.start) > 0.5 * ramps.amplitude


def _compliance(branch: Branch, low: float, high: float) -> float:
    """Slope of the line through the angles over the torques of a range, rad/(N·m)."""
    torque = math.copysign(1.0, branch.end) * np.linspace(low, high, _LEVELS)
    return float(np.polynomial.polynomial.polyfit(torque, branch.angle_at(torque), 1)[1])


# Play model


def _play_model(loops: Sequence[Loop], spring: Estimate, settings: Settings) -> PlayModel:
    compliance = spring.inverse()
    plays, frictions, residuals, centres = _fits(loops, compliance.value)
    reading = math.sqrt(2.0) * resolution(settings.angle_step)
    play_parts = [Component(reading)]
    friction_parts = [Component(0.5 * spring.value * reading)]
    if compliance.standard:
        # What the figures would be with another spring, GUM 5.1.3, note 2.
        softer, stiffer = (
            _fits(loops, compliance.value + change)
            for change in (compliance.standard, -compliance.standard)
        )
        for parts, more, less in zip((play_parts, friction_parts), softer, stiffer, strict=False):
            change = 0.5 * abs(float(np.mean(more) - np.mean(less)))
            parts.append(Component(change, compliance.degrees_of_freedom))
    return PlayModel(
        spring.value,
        Estimate.of_mean(plays, *play_parts),
        Estimate.of_mean(frictions, *friction_parts),
        math.sqrt(float(np.mean(np.square(residuals)))),
        float(np.mean(centres)),
    )


def _fits(loops: Sequence[Loop], compliance: float) -> tuple[list[float], ...]:
    """What `_fit` gives for each loop, sorted by quantity."""
    return tuple(map(list, zip(*(_fit(loop, compliance) for loop in loops), strict=True)))


def _fit(loop: Loop, compliance: float) -> tuple[float, float, float, float]:
    """Fit play (rad) and friction (N·m) to a loop; then residual and centre, rad.

    The friction holds back a part of the torque; the spring gives way to the rest, which changes
    once the torque has gone back by twice the friction. On either side of the play the angle less
    the spring's is a constant, and the play is their difference. Medians bear what sticks and
    slips.
    """
    ways = [
        (branch, np.linspace(branch.start, _opposite(branch, loop), _LEVELS))
        for branch in (loop.fall, loop.rise)
    ]
    angle = np.concatenate([branch.angle_at(torque) for branch, torque in ways])

    def sides_of(friction: float) -> tuple[float, float, Array]:
        load = np.concatenate([_transmitted(torque, friction) for _, torque in ways])
        rest = angle - compliance * load
        sides = load > 0.0
        upper, lower = np.median(rest[sides]), np.median(rest[~sides])
        return float(upper), float(lower), rest - np.where(sides, upper, lower)

    friction = _minimum(
        lambda friction: float(np.sum(np.abs(sides_of(friction)[2]))), 0.98 * loop.amplitude
    )
    upper, lower, rest = sides_of(friction)
    return upper - lower, friction, float(np.sqrt(np.mean(rest**2))), 0.5 * (upper + lower)


def _opposite(branch: Branch, loop: Loop) -> float:
    """How far a branch belongs to the loop: to where the other one starts."""
    other = loop.rise if branch is loop.fall else loop.fall
    return max(branch.end, other.start) if branch is loop.fall else min(branch.end, other.start)


def _transmitted(torque: Array, friction: float) -> Array:
    """What friction leaves of a torque on its way from one peak to the other."""
    sign = 1.0 if torque[-1] > torque[0] else -1.0
    load: Array = np.maximum(sign * torque - friction, sign * torque[0] + friction)
    return sign * load


def _minimum(cost: Callable[[float], float], high: float) -> float:
    """Where a function of one variable is least, from 0 on; it may have several minima."""
    tried: NDArray[np.float64] = np.linspace(0.0, high, _FRICTIONS)
    for _ in range(_REFINEMENTS):
        best = int(np.argmin([cost(value) for value in tried.tolist()]))
        beside = tried[max(best - 1, 0)], tried[min(best + 1, len(tried) - 1)]
        tried = np.linspace(*beside, _FINER)
    return float(tried[int(np.argmin([cost(value) for value in tried.tolist()]))])

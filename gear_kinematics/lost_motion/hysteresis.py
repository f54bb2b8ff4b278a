"""The figures of a hysteresis curve, by the definitions in docs/lost_motion.md.

The spring of the play model is taken from the largest ramps, which load the gear.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.lost_motion.ramps import Array, HalfLoop, Loop, RampError, Ramps
from gear_kinematics.state.uncertainty import Component, Estimate, resolution

LOST_MOTION_SHARE = 0.03
"""Lost motion is measured between ± this share of the rated torque."""
STIFFNESS_SHARES = (0.15, 0.5)
"""Limits between the ranges of stiffness, as shares of the rated torque."""

_LEAST_RANGE = 1.5
"""Least ratio of the torques at the end and at the beginning of a range of stiffness."""
_ROUNDING = 1e-11
"""Relative rounding error of sums of many angles."""
_LEVELS = 200
"""Torques at which a curve is compared with a straight line or with the model."""
_FRICTIONS = 50
"""Values of the friction that are tried first."""
_FINER, _REFINEMENTS = 11, 4
"""Values that are then tried around the best one, and how often this is repeated."""


@dataclass(frozen=True, slots=True)
class Stiffness:
    """Torsional stiffness over a range of torque, N·m/rad, while the load increases."""

    low: float
    """N·m, magnitude."""
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
    """N·m/rad, of the spring: from the highest range of the largest ramps, clear of zero."""
    play: Estimate
    """rad: the backlash."""
    friction: Estimate
    """N·m, at the output."""
    residual: float
    """rad, root mean square of the angle minus the model's."""
    centre: float
    """rad, the angle in the middle of the play."""

    def loop(self, amplitude: float) -> tuple[Array, Array]:
        """Torques and angles of the model's hysteresis loop, from one peak back to it."""
        torque = amplitude * np.linspace(1.0, -1.0, _LEVELS)
        fall = _transmitted(torque, self.friction.value)
        load = np.concatenate([fall, -fall])
        angle = self.centre + load / self.stiffness + 0.5 * self.play.value * np.sign(load)
        return np.concatenate([torque, -torque]), angle


@dataclass(frozen=True, slots=True)
class Figures:
    """Results from the ramps of one amplitude."""

    amplitude: float
    """N·m."""
    loops: int
    hysteresis: Estimate
    """rad, the width of the curve at zero torque."""
    lost_motion: Estimate | None
    """rad, on the middle line, see `LOST_MOTION_SHARE`; None if the ramps are too small."""
    stiffness: tuple[Stiffness, ...]
    """In the ranges that the ramps cover."""
    play_model: PlayModel | None = None
    """None if no range of stiffness is clear of zero: the spring is then unknown."""

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
    """Reference values of the figures."""

    rated_torque: float
    """N·m."""
    corners: tuple[float, ...]
    """N·m, ascending: limits between the ranges of stiffness."""
    angle_step: float
    """rad at the output, between readings of the encoder; 0 if unknown."""


def figures(ramps: Sequence[Ramps], settings: Settings) -> tuple[Figures, ...]:
    """Compute the figures of ramps, in ascending order of amplitude.

    Raises:
        RampError: if the angle does not grow with the torque.
    """
    _check(ramps[-1], settings)
    stiffness = [_stiffness(group, settings) for group in ramps]
    # A range that begins at zero torque includes the play.
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
    """Check that the angle grows with the torque."""
    ways = [loop.fall.angle[0] - loop.rise.angle[0] for loop in ramps.loops]
    if float(np.mean(ways)) <= _still(ramps, settings):
        raise RampError(
            'the angle does not grow with the torque: it stands still, or one of them has the '
            'wrong sign'
        )


def _still(ramps: Ramps, settings: Settings) -> float:
    """Difference up to which two angles may be equal, rad."""
    angles = [half.angle for loop in ramps.loops for half in (loop.fall, loop.rise)]
    return max(settings.angle_step, _ROUNDING * float(np.max(np.abs(np.concatenate(angles)))))


def _hysteresis(loops: Sequence[Loop], settings: Settings) -> Estimate:
    reading = resolution(settings.angle_step)
    widths = [loop.width(0.0) for loop in loops]
    rounding = np.mean([loop.fall.rounding(0.0) - loop.rise.rounding(0.0) for loop in loops])
    return Estimate.of_mean(widths, Component(math.sqrt(2.0) * reading), _rounded(rounding))


def _rounded(rounding: float | np.floating) -> Component:
    """Take errors up to the rounding, rad, as equally likely (GUM 4.3.7)."""
    return Component(abs(float(rounding)) / math.sqrt(3.0))


def _lost_motion(loops: Sequence[Loop], settings: Settings) -> Estimate | None:
    torque = LOST_MOTION_SHARE * settings.rated_torque
    ways = [
        [half for half in halves if half.reaches(torque) and half.reaches(-torque)]
        for halves in ([loop.fall for loop in loops], [loop.rise for loop in loops])
    ]
    if not all(ways):
        return None
    angles = [[float(b.angle_at(torque) - b.angle_at(-torque)) for b in way] for way in ways]
    rounding = [np.mean([b.rounding(torque) - b.rounding(-torque) for b in way]) for way in ways]
    # Four readings, each weighted by 1/2.
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
            [_compliance(half, low, min(high, abs(half.end))) for half in pull]
            for pull in ramps.pulls
            if all(_loads(half, low, ramps) for half in pull)
        ]
        if pulls:
            positive, negative = zip(*pulls, strict=True)
            both = [0.5 * (a + b) for a, b in pulls]
            reading = Component(math.sqrt(2.0) * resolution(settings.angle_step) / (high - low))
            compliances = (both, positive, negative)
            if min(map(np.mean, compliances)) * (high - low) <= still:
                continue  # friction holds the gear throughout
            found.append(
                Stiffness(
                    low, high, *(Estimate.of_mean(c, reading).inverse() for c in compliances)
                )
            )
    return tuple(found)


def _loads(half: HalfLoop, low: float, ramps: Ramps) -> bool:
    """Whether, from the torque `low` on, a half loop is like a full loading of these ramps.

    One from a smaller peak is so beyond that peak, where hysteresis has lost its memory of it.
    """
    return abs(half.start) < low or abs(half.start) > 0.5 * ramps.amplitude


def _compliance(half: HalfLoop, low: float, high: float) -> float:
    """Slope of the line through the angles over the torques of a range, rad/(N·m)."""
    torque = math.copysign(1.0, half.end) * np.linspace(low, high, _LEVELS)
    return float(np.polynomial.polynomial.polyfit(torque, half.angle_at(torque), 1)[1])


# Play model


def _play_model(loops: Sequence[Loop], spring: Estimate, settings: Settings) -> PlayModel:
    compliance = spring.inverse()
    plays, frictions, residuals, centres = _fits(loops, compliance.value)
    reading = math.sqrt(2.0) * resolution(settings.angle_step)
    play_parts = [Component(reading)]
    friction_parts = [Component(0.5 * spring.value * reading)]
    if compliance.standard:
        # Sensitivity to the compliance of the spring (GUM 5.1.3, note 2).
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
    """Apply `_fit` to each loop; returns a list per quantity."""
    return tuple(map(list, zip(*(_fit(loop, compliance) for loop in loops), strict=True)))


def _fit(loop: Loop, compliance: float) -> tuple[float, float, float, float]:
    """Fit play (rad) and friction (N·m) to a loop; also returns residual and centre, rad.

    The spring carries the torque minus the friction; after a reversal its load changes once the
    torque has gone back by twice the friction. On either side of the play, the angle minus the
    spring's is constant; the play is the difference of the two constants. Medians are robust
    against stick-slip.
    """
    ways = [
        (half, np.linspace(half.start, _opposite(half, loop), _LEVELS))
        for half in (loop.fall, loop.rise)
    ]
    angle = np.concatenate([half.angle_at(torque) for half, torque in ways])

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


def _opposite(half: HalfLoop, loop: Loop) -> float:
    """Torque at which a half loop leaves the loop: where the other one starts."""
    other = loop.rise if half is loop.fall else loop.fall
    return max(half.end, other.start) if half is loop.fall else min(half.end, other.start)


def _transmitted(torque: Array, friction: float) -> Array:
    """Torque on the spring, on the way from one peak to the other."""
    sign = 1.0 if torque[-1] > torque[0] else -1.0
    load: Array = np.maximum(sign * torque - friction, sign * torque[0] + friction)
    return sign * load


def _minimum(cost: Callable[[float], float], high: float) -> float:
    """Find the minimum of a function on [0, high]; it may have several local ones."""
    tried: NDArray[np.float64] = np.linspace(0.0, high, _FRICTIONS)
    for _ in range(_REFINEMENTS):
        best = int(np.argmin([cost(value) for value in tried.tolist()]))
        beside = tried[max(best - 1, 0)], tried[min(best + 1, len(tried) - 1)]
        tried = np.linspace(*beside, _FINER)
    return float(tried[int(np.argmin([cost(value) for value in tried.tolist()]))])

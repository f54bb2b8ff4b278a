"""The figures of a hysteresis curve, by the definitions in docs/lost_motion.md."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from gear_kinematics.lost_motion.static.play import Cause, PlayModel
from gear_kinematics.lost_motion.static.ramps import HalfLoop, Loop, RampError, Ramps
from gear_kinematics.lost_motion.static.rate import rate_of
from gear_kinematics.state.uncertainty import (
    Component,
    Estimate,
    by_steps,
    common_part,
    hidden_resolution,
    slope_resolution,
)

LOST_MOTION_SHARE = 0.03
"""Lost motion is measured between ± this share of the rated torque."""
STIFFNESS_SHARES = (0.15, 0.5)
"""Limits between the ranges of stiffness, as shares of the rated torque."""

_LEAST_RANGE = 1.5
"""Least ratio of the torques at the end and at the beginning of a range of stiffness."""
_ROUNDING = 1e-11
"""Relative rounding error of sums of many angles."""
_LEVELS = 200
"""Torques at which a curve is compared with a straight line."""


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
    """None if the loops have no middle line."""

    @property
    def play(self) -> Estimate | None:
        """rad, by the play model; None where it has no value."""
        return self.play_model.play if self.play_model else None

    @property
    def within(self) -> bool:
        """Whether the ramps stay within the play."""
        return self.play_model is not None and self.play_model.cause == Cause.WITHIN

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
    late: float = 0.0
    """s, standard uncertainty of the lag of the encoder that has been taken out."""


def figures(
    ramps: Sequence[Ramps], settings: Settings, models: Sequence[PlayModel | None]
) -> tuple[Figures, ...]:
    """Compute the figures of ramps, in ascending order of amplitude.

    Args:
        ramps: of each amplitude.
        settings: reference values.
        models: of the ramps of each amplitude.
    """
    return tuple(
        Figures(
            amplitude=group.amplitude,
            loops=len(group.loops),
            hysteresis=_hysteresis(group, settings),
            lost_motion=_lost_motion(group.loops, settings),
            stiffness=_stiffness(group, settings),
            play_model=model,
        )
        for group, model in zip(ramps, models, strict=True)
    )


def check(ramps: Ramps, angle_step: float) -> None:
    """Check that the angle grows with the torque.

    Raises:
        RampError: if it does not.
    """
    ways = [loop.fall.angle[0] - loop.rise.angle[0] for loop in ramps.loops]
    if float(np.mean(ways)) <= _still(ramps, angle_step):
        raise RampError(
            'the angle does not grow with the torque: it stands still, or one of them has the '
            'wrong sign'
        )


def _still(ramps: Ramps, angle_step: float) -> float:
    """Difference up to which two angles may be equal, rad."""
    angles = [half.angle for loop in ramps.loops for half in (loop.fall, loop.rise)]
    return max(angle_step, _ROUNDING * float(np.max(np.abs(np.concatenate(angles)))))


def _hysteresis(ramps: Ramps, settings: Settings) -> Estimate:
    loops = ramps.loops
    widths = [loop.width(0.0) for loop in loops]
    return Estimate.of_mean(
        widths,
        Component(hidden_resolution(settings.angle_step, widths, readings=2)),
        _rounded([loop.fall.rounding(0.0) - loop.rise.rounding(0.0) for loop in loops]),
        Component(_late(ramps, settings.late)),
    )


def _late(ramps: Ramps, late: float) -> float:
    """Change of the width by a time by which the encoder may be late, s, in rad."""
    rate = rate_of(ramps) if late else None
    if not rate:
        return 0.0
    torque = rate.rate * late
    widths = [
        loop.fall.angle_at(torque) - loop.rise.angle_at(-torque) - loop.width(0.0)
        for loop in ramps.loops
    ]
    return abs(float(np.mean(widths)))


def _rounded(roundings: Sequence[float]) -> Component:
    """Take errors up to the rounding of corners, rad, as equally likely (GUM 4.3.7)."""
    return Component(common_part(np.array(roundings)) / math.sqrt(3.0))


def _lost_motion(loops: Sequence[Loop], settings: Settings) -> Estimate | None:
    torque = LOST_MOTION_SHARE * settings.rated_torque
    ways = [
        [half for half in halves if half.reaches(torque) and half.reaches(-torque)]
        for halves in ([loop.fall for loop in loops], [loop.rise for loop in loops])
    ]
    if not all(ways):
        return None
    angles = [[float(b.angle_at(torque) - b.angle_at(-torque)) for b in way] for way in ways]
    readings = [Component(0.5 * hidden_resolution(settings.angle_step, a, 2)) for a in angles]
    rounding = [b.rounding(torque) - b.rounding(-torque) for way in ways for b in way]
    return Estimate.of_sum([(0.5, way) for way in angles], *readings, _rounded(rounding))


# Stiffness


def _stiffness(ramps: Ramps, settings: Settings) -> tuple[Stiffness, ...]:
    corners = (0.0, *(corner for corner in settings.corners if corner < ramps.amplitude))
    found, still = [], _still(ramps, settings.angle_step)
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
            compliances = (both, positive, negative)
            least = min(float(np.mean(c)) for c in compliances)
            if least * (high - low) <= still:
                continue  # friction holds the gear throughout
            steps = slope_resolution(settings.angle_step, high - low, least)
            reading = by_steps(steps, len(pulls))
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

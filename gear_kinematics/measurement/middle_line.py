# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The middle line of hysteresis loops, and the backlash that it leaves room for.

At one angle, the torque exceeds the load on the spring by the friction while it rises, and falls
short of it by the friction while it falls. Half the sum of both is the load, half the difference
the friction, whatever it depends on. What is left is the curve of a spring without friction, and
the backlash is the angle in its middle over which there is no load.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from operator import itemgetter
from typing import NamedTuple

import numpy as np

from gear_kinematics.measurement.loops import Array, Loop, Ramps
from gear_kinematics.measurement.sentences import Cause
from gear_kinematics.statistics.uncertainty import Estimate, resolution, student_t

_ANGLES = 400  # number of angles at which a loop is known
_POINTS = 20
"""Number of points of the mean line on either side: springs and frictions of 5, 10, 20 and 40
points give back the loops of 30 real recordings within 3.1, 2.2, 1.8 and 1.7 mrad (median), whose
repeats differ by 2.5."""
_LOADS = 40  # number of loads at which the angle is read for a line through one side
_SIDE, _LOWER_HALF, _UPPER_HALF = (0.1, 0.9), (0.1, 0.35), (0.35, 0.9)
"""Parts of either side of the curve, as shares of the greatest load: of all of it that friction
at the reversals leaves, and of its two halves, between which a bent spring differs."""
_EXTRAPOLATED = 2.0
"""By how many times the difference of the halves a bent spring goes on towards no load: more than
by the power 1/2 of the load, whose dead band goes on by 1.9 times (1.2 times by Hertz's 2/3)."""
_HIDDEN = 0.5
"""Share of the uncertainty of that difference which the ± of a straight one contains: on simulated
gears (benchmark/lost_motion.py), 0.5 holds in 97 % or more of each scenario, 0 in 88 %."""
_MIDDLE, _DEAD = 2.0 / 3.0, 0.15
"""A dead band yields over this share of its width at less than this share of the stiffness beside
it. Simulated: a fifth takes a soft middle of 60 in 300 N·m/rad for play, a tenth misses one of ten
plays of 10′ where friction takes up half of the torque."""
MOST_FRICTION = 0.8  #: share of the torque beyond which friction hardly lets the spring be loaded
_MOST_COMPLIANT = 1.5
"""Ratio of the compliances of small and large ramps from which on the small ones are in a soft
middle: springs that bend by less keep a backlash of 0 and of 10′ in their intervals."""
_MOVED_BY_GAP = 2.0
"""By how many times the friction that a gap adds, over the stiffness, moves its ends: simulated
gears with inertia need 1.7 at the most."""
_NORMAL = 10**9  # degrees of freedom of a normal distribution


class Backlash(NamedTuple):
    """The backlash that a recording leaves room for, rad."""

    low: float
    high: float | None  #: None where nothing bounds it
    cause: Cause  #: why it has no value

    @property
    def value(self) -> Estimate | None:
        """The middle of the interval ± half of it; None unless a dead band is clear."""
        if self.cause != Cause.NONE or self.high is None or self.low <= 0.0:
            return None
        half = 0.5 * (self.high - self.low)
        return Estimate(self.low + half, half / student_t(_NORMAL), math.inf, 1)


@dataclass(frozen=True, eq=False, slots=True)
class MiddleLine:
    """Middle line of a loop, in the order of the angle: (n,) each, rad and N·m."""

    angle: Array
    load: Array  #: non-decreasing
    friction: Array

    @classmethod
    def of(cls, loop: Loop) -> 'MiddleLine':
        """Read the middle line of a complete loop."""
        fall, rise = loop.fall, loop.rise
        ways = [
            (half.torque[::way], _monotonic(half.angle[::way]))
            for half, way in ((rise, 1), (fall, -1))
        ]
        low = max(angle[0] for _, angle in ways)
        high = min(angle[-1] for _, angle in ways)
        at = np.linspace(low, high, _ANGLES)
        forth, back = (np.interp(at, _distinct(angle), torque) for torque, angle in ways)
        return cls(at, _monotonic(0.5 * (forth + back)), 0.5 * (forth - back))

    def angle_at(self, load: Array | float) -> Array:
        """The angle at loads, rad, of the same shape."""
        return np.asarray(np.interp(load, _distinct(self.load), self.angle))

    def width(self, load: float) -> float:
        """The angle between a load and the same load of the other sign, rad."""
        return float(self.angle_at(load) - self.angle_at(-load))

    def dead_band(self, low: float, high: float) -> tuple[float, float]:
        """Where straight lines through both sides, between two loads, meet no load.

        Returns:
            The angle between them, rad, and the mean of their compliances, rad/(N·m).
        """
        loads = np.linspace(low, high, _LOADS)
        (right, slope), (left, other) = (
            np.polynomial.polynomial.polyfit(loads, self.angle_at(sign * loads), 1)
            for sign in (1.0, -1.0)
        )
        return float(right - left), float(0.5 * (slope - other))

    def stiffness_within(self, width: float) -> float:
        """Mean stiffness over an angle about the middle, N·m/rad."""
        load = _SIDE[0] * 0.5 * float(np.ptp(self.load))
        middle = 0.5 * float(self.angle_at(load) + self.angle_at(-load))
        ends = middle + 0.5 * width * np.array([-1.0, 1.0])
        return float(np.diff(np.interp(ends, self.angle, self.load))[0]) / width

    def friction_within(self, load: float) -> float:
        """Mean friction at loads up to one of either sign, N·m."""
        angles = self.angle_at(np.linspace(-load, load, _LOADS))
        return float(np.mean(np.interp(angles, self.angle, self.friction)))

    def friction_of_gap(self) -> float:
        """By how much friction at less than a tenth of the load exceeds that beyond, N·m."""
        reach = 0.5 * float(np.ptp(self.load))
        within = np.abs(self.load) < _SIDE[0] * reach
        beyond = ~within & (np.abs(self.load) < MOST_FRICTION * reach)
        if not (within.any() and beyond.any()):
            return 0.0
        return float(np.mean(self.friction[within]) - np.mean(self.friction[beyond]))


def middle_lines(ramps: Ramps) -> list[MiddleLine]:
    """The middle lines of the complete loops of ramps, without those in which nothing moves."""
    lines = (MiddleLine.of(loop) for loop in ramps.loops if loop.complete)
    return [line for line in lines if np.ptp(line.angle) > 0.0]


def mean_line(lines: Sequence[MiddleLine], ramps: Ramps) -> MiddleLine:
    """The mean of the middle lines of ramps: at 0 rad, there is no load.

    If no loop is complete, so that there are none, each counts with one half and its image.
    """
    lines = [
        replace(line, angle=line.angle - line.angle_at(0.0))
        for line in lines or [MiddleLine.of(loop.completed) for loop in ramps.loops]
    ]
    low, high = max(line.angle[0] for line in lines), min(line.angle[-1] for line in lines)
    angle = np.concatenate(
        [np.linspace(low, 0.0, _POINTS, endpoint=False), np.linspace(0.0, high, _POINTS + 1)]
    )
    load, friction = (
        np.mean([np.interp(angle, line.angle, getattr(line, name)) for line in lines], axis=0)
        for name in ('load', 'friction')
    )
    return MiddleLine(angle, np.where(angle, load, 0.0), friction)


def stiffness_of(lines: Sequence[MiddleLine], ramps: Ramps) -> float:
    """Mean stiffness of both sides of middle lines, N·m/rad; 0 if there are none, or no load."""
    reach = _reach(lines, ramps) if lines else 0.0
    if reach <= 0.0:
        return 0.0
    low, high = _SIDE
    return 1.0 / float(np.mean([line.dead_band(low * reach, high * reach)[1] for line in lines]))


def backlash_of(
    lines: Sequence[MiddleLine],
    ramps: Ramps,
    hysteresis: Estimate,
    step: float,
    loaded: float,
    light: float,
) -> Backlash | None:
    """Bound the backlash by ramps of one amplitude; None where they do not bound it.

    Straight lines are fitted to both sides of the middle lines. Where those through the halves of
    a side agree, the spring is straight, and the angle between the lines is the backlash. Where
    they differ, it lies between what they give and what they extrapolate to. It has a lower bound
    only if the load hardly changes over it, and is never wider than the hysteresis. Ramps to which
    the gear yields much more than to larger ones have not left a soft middle, which may all be
    backlash: that is bounded by the angle between small loads alone.

    Args:
        lines: of the complete loops.
        ramps: with these loops.
        hysteresis: of the same ramps, rad.
        step: rad, between readings of the encoder; 0 if unknown.
        loaded: stiffness of the largest ramps, N·m/rad; 0 if unknown.
        light: torque, N·m, that ramps with a soft middle certainly reach.
    """
    if hysteresis.uncertainty is None:
        return Backlash(0.0, None, Cause.REPEATS)
    most = hysteresis.value + hysteresis.expanded
    if not lines:
        return Backlash(0.0, most, Cause.REPEATS)
    if _friction(lines) > MOST_FRICTION * ramps.amplitude:
        return None
    reach = _reach(lines, ramps)
    if reach <= 0.0:
        return Backlash(0.0, most, Cause.FRICTION)
    if len(lines) == 1:
        return Backlash(0.0, most, Cause.REPEATS)
    side, near, far = (
        np.array([line.dead_band(low * reach, high * reach) for line in lines])
        for low, high in (_SIDE, _LOWER_HALF, _UPPER_HALF)
    )
    stiffness = 1.0 / float(np.mean(side[:, 1]))
    reading = resolution(step) + resolution(_spacing(ramps)) / stiffness
    whole, bend = Estimate.of_mean(side[:, 0]), Estimate.of_mean(far[:, 0] - near[:, 0])
    bent = abs(bend.value) > bend.expanded + reading
    if bent:
        beyond = Estimate.of_mean(near[:, 0] - _EXTRAPOLATED * (far[:, 0] - near[:, 0]))
        guesses = [(e.value, e.expanded) for e in (whole, Estimate.of_mean(near[:, 0]), beyond)]
    else:
        guesses = [(whole.value, math.hypot(whole.expanded, _HIDDEN * bend.expanded))]
    # A gear that speeds up in a gap takes more torque there, as if it were loaded at its ends.
    more = Estimate.of_mean([line.friction_of_gap() for line in lines])
    moved = reading
    if more.value > more.expanded:
        moved += _MOVED_BY_GAP * more.value / stiffness
    low = min(value - spread for value, spread in guesses) - moved
    high = max(value + spread for value, spread in guesses) + moved
    soft = stiffness * _MOST_COMPLIANT < loaded
    if soft:
        wide = Estimate.of_mean([line.width(light) for line in lines])
        low, high = 0.0, max(high, wide.value + wide.expanded)
    high = min(max(high, step), most)
    if low <= 0.0:
        return Backlash(0.0, high, Cause.SOFT if soft else Cause.BENT if bent else Cause.NONE)
    within = Estimate.of_mean([line.stiffness_within(_MIDDLE * whole.value) for line in lines])
    if within.value + within.expanded > _DEAD * stiffness:
        return Backlash(0.0, high, Cause.SOFT)
    return Backlash(min(low, high), high, Cause.BENT if bent else Cause.NONE)


def reconciled(found: Sequence[Backlash | None]) -> Backlash:
    """The backlash that ramps of ascending amplitudes leave room for; a gear has only one."""
    known = [(own.high, own.low, own.cause) for own in found if own and own.high is not None]
    if not known:
        cause = next((own.cause for own in found if own), Cause.FRICTION)
        return Backlash(0.0, None, cause)
    highs, lows, causes = zip(*known, strict=True)
    if Cause.SOFT in causes:
        # A soft middle, which small ramps have not left, is play to larger ones.
        lows = lows[: causes.index(Cause.SOFT) + 1]
    if max(lows) > min(highs):
        return Backlash(min(lows), max(highs), Cause.CONTRADICTION)
    high, _, cause = min(known, key=itemgetter(0))
    return Backlash(max(lows), high, cause)


def _monotonic(values: Array) -> Array:
    """A non-decreasing sequence: midway between what was reached before and what stays behind."""
    reached = np.maximum.accumulate(values)
    left: Array = np.minimum.accumulate(values[::-1])[::-1]
    return 0.5 * (reached + left)


def _distinct(values: Array) -> Array:
    """Tell equal values apart, by rounding errors of the greatest, in their order."""
    apart: Array = np.spacing(np.max(np.abs(values))) * np.arange(len(values))
    return values + apart


def _spacing(ramps: Ramps) -> float:
    """Between samples of the torque, N·m."""
    return float(np.mean([np.median(np.abs(np.diff(half.torque))) for half in ramps.halves]))


def _friction(lines: Sequence[MiddleLine]) -> float:
    return float(np.mean([np.mean(line.friction) for line in lines]))


def _reach(lines: Sequence[MiddleLine], ramps: Ramps) -> float:
    """Load that the gear certainly reaches on both sides, N·m, clear of the reversals."""
    margin = _ANGLES // 40
    reached = (min(float(line.load[-margin]), -float(line.load[margin])) for line in lines)
    return min(ramps.amplitude - _friction(lines), *reached)

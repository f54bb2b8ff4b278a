# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The backlash that middle lines leave room for: the angle in their middle without a load."""

import math
from collections.abc import Sequence
from dataclasses import replace
from operator import itemgetter
from typing import NamedTuple

import numpy as np

from gear_kinematics.measurement.loops import ANGLES, MOST_FRICTION, SIDE, Array, MiddleLine, Ramps
from gear_kinematics.measurement.sentences import Cause
from gear_kinematics.statistics.uncertainty import Estimate, resolution, student_t

_POINTS = 20
"""Number of points of the mean line on either side. With 5, 10, 20 and 40 points of spring and
friction, the loops of 30 real recordings follow within 3.1, 2.2, 1.8 and 1.7 mrad (median);
their repeats differ by 2.5 mrad."""
_LOWER_HALF, _UPPER_HALF = (0.1, 0.35), (0.35, 0.9)
"""The two halves of `SIDE`; a spring that differs between them is bent."""
_EXTRAPOLATED = 2.0
"""How far a bent spring is extrapolated to no load, in differences of its halves. A twist by the
power 1/2 of the load needs 1.9, and by Hertz's power 2/3 1.2."""
_HIDDEN = 0.5
"""Share of the uncertainty of that difference that the ± of a straight spring includes: with 0.5,
97 % or more of each scenario of benchmark/lost_motion.py are within ±; with 0, 88 %."""
_MIDDLE, _DEAD = 2.0 / 3.0, 0.15
"""A dead band has, over the first share of its width, less than the second share of the stiffness
beside it. In simulations, 0.2 takes a soft middle of 60 in 300 N·m/rad for play, and 0.1
misses one of ten plays of 10′ where friction takes up half of the torque."""
_MOST_COMPLIANT = 1.5
"""Ratio of the compliances of small and large ramps from which on small ones are in a soft middle.
With springs that bend by less, the intervals contain backlashes of 0 and of 10′."""
_MOVED_BY_GAP = 2.0
"""How far the friction that a gap adds moves its ends, in that friction over the stiffness. In
simulations of gears with inertia, at most 1.7."""
_FEW_STEPS = 32.0
"""Steps of the encoder on a side from which on a reading bounds the error of the dead band by
itself: two lines through n steps differ by 2 sqrt(4/n) sqrt(2) standard deviations of a reading
with a probability of 95 %."""
_NORMAL = 10**9  # degrees of freedom of a normal distribution


class Backlash(NamedTuple):
    """The backlash that a recording leaves room for, rad."""

    low: float
    high: float | None  #: None where nothing bounds it
    cause: Cause  #: why it has no value

    @property
    def ends(self) -> tuple[float, ...]:
        """Both ends of the interval; none where nothing bounds it."""
        return () if self.high is None else (self.low, self.high)

    @property
    def value(self) -> Estimate | None:
        """The middle of the interval ± half of it; None unless a dead band is clear."""
        if self.cause != Cause.NONE or self.high is None or self.low <= 0.0:
            return None
        half = 0.5 * (self.high - self.low)
        return Estimate(self.low + half, half / student_t(_NORMAL), math.inf, 1)


def mean_line(ramps: Ramps) -> MiddleLine:
    """Return the mean of the middle lines of ramps, with its zero where there is no load.

    If no loop is complete, each counts with one half and its mirror image.
    """
    lines = [
        replace(line, angle=line.angle - line.angle_at(0.0))
        for line in ramps.lines or [MiddleLine.of(loop.completed) for loop in ramps.loops]
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


def stiffness_of(ramps: Ramps) -> float:
    """Return the mean stiffness of both sides, N·m/rad; 0 without a middle line or a load."""
    if not ramps.lines or (reach := _reach(ramps)) <= 0.0:
        return 0.0
    return 1.0 / float(np.mean(_dead_bands(ramps, reach, SIDE)[:, 1]))


def backlash_of(
    ramps: Ramps, hysteresis: Estimate, loaded: float, light: float
) -> Backlash | None:
    """Bound the backlash by ramps of one amplitude; None where they do not bound it.

    Straight lines are fitted to both sides of the middle lines. Where those through the halves of
    a side agree, the spring is straight, and the angle between the lines is the backlash. Where
    they differ, it lies between what they give and what they extrapolate to. It has a lower bound
    only if the load hardly changes over it, and it never exceeds the hysteresis. If the gear
    yields much more to these ramps than to larger ones, they have not left a soft middle, all of
    which may be backlash: then only the angle between small loads bounds it.

    Args:
        ramps: the ramps.
        hysteresis: their hysteresis, rad.
        loaded: stiffness of the largest ramps, N·m/rad; 0 if unknown.
        light: torque, N·m, that ramps with a soft middle certainly reach.
    """
    if hysteresis.uncertainty is None:
        return Backlash(0.0, None, Cause.REPEATS)
    most = hysteresis.value + hysteresis.expanded
    lines = ramps.lines
    if not lines:
        return Backlash(0.0, most, Cause.REPEATS)
    if _friction(ramps) > MOST_FRICTION * ramps.amplitude:
        return None
    if (reach := _reach(ramps)) <= 0.0:
        return Backlash(0.0, most, Cause.FRICTION)
    if len(lines) == 1:
        return Backlash(0.0, most, Cause.REPEATS)
    side, near, far = (
        _dead_bands(ramps, reach, part) for part in (SIDE, _LOWER_HALF, _UPPER_HALF)
    )
    stiffness = 1.0 / float(np.mean(side[:, 1]))
    # A line through a side of few steps of the encoder may be off by more than one reading.
    coarse = max(1.0, math.sqrt(_FEW_STEPS * ramps.step * stiffness / reach))
    reading = coarse * resolution(ramps.step) + resolution(_spacing(ramps)) / stiffness
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
    high = min(max(high, ramps.step), most)
    if low <= 0.0:
        return Backlash(0.0, high, Cause.SOFT if soft else Cause.BENT if bent else Cause.NONE)
    within = Estimate.of_mean([line.stiffness_within(_MIDDLE * whole.value) for line in lines])
    if within.value + within.expanded > _DEAD * stiffness:
        return Backlash(0.0, high, Cause.SOFT)
    return Backlash(min(low, high), high, Cause.BENT if bent else Cause.NONE)


def reconciled(found: Sequence[Backlash | None]) -> Backlash:
    """Combine what ramps of ascending amplitudes say of the backlash; a gear has only one."""
    known = [(own.high, own.low, own.cause) for own in found if own and own.high is not None]
    if not known:
        cause = next((own.cause for own in found if own), Cause.FRICTION)
        return Backlash(0.0, None, cause)
    highs, lows, causes = zip(*known, strict=True)
    if Cause.SOFT in causes:
        # A soft middle, which small ramps do not leave, looks like play to larger ones.
        lows = lows[: causes.index(Cause.SOFT) + 1]
    if max(lows) > min(highs):
        return Backlash(min(lows), max(highs), Cause.CONTRADICTION)
    high, _, cause = min(known, key=itemgetter(0))
    return Backlash(max(lows), high, cause)


def _spacing(ramps: Ramps) -> float:
    """Usual distance between samples of the torque, N·m."""
    return float(np.mean([np.median(np.abs(np.diff(half.torque))) for half in ramps.halves]))


def _dead_bands(ramps: Ramps, reach: float, part: tuple[float, float]) -> Array:
    """Dead band and compliance of each middle line by a part of the loads reached, (lines, 2)."""
    low, high = part
    return np.array([line.dead_band(low * reach, high * reach) for line in ramps.lines])


def _friction(ramps: Ramps) -> float:
    return float(np.mean([np.mean(line.friction) for line in ramps.lines]))


def _reach(ramps: Ramps) -> float:
    """Load that the gear certainly reaches on both sides, N·m, clear of the reversals."""
    margin = ANGLES // 40
    reached = (min(float(line.load[-margin]), -float(line.load[margin])) for line in ramps.lines)
    return min(ramps.amplitude - _friction(ramps), *reached)

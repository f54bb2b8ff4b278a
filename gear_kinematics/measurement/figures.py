# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The figures of a hysteresis curve as catalogues give them; docs/lost_motion.md defines them."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from gear_kinematics.measurement.backlash import (
    Backlash,
    backlash_of,
    mean_line,
    reconciled,
    stiffness_of,
)
from gear_kinematics.measurement.loops import MOST_FRICTION, HalfLoop, MiddleLine, RampError, Ramps
from gear_kinematics.measurement.measured import HYSTERESIS, LOST_MOTION, Measured
from gear_kinematics.report.document import number
from gear_kinematics.statistics.uncertainty import Component, Estimate, resolution

LOST_MOTION_SHARE = 0.03  #: lost motion is measured between ± this share of the rated torque
STIFFNESS_SHARES = (0.15, 0.5)  #: limits between ranges of stiffness, shares of the rated torque
_LEAST_RANGE = 1.5  # least ratio of the torques at the end and at the beginning of a range
_ROUNDING = 1e-11  # relative rounding error of sums of many angles
_TORQUES = 200  # at which a curve is compared with a straight line


@dataclass(frozen=True, slots=True)
class MeasuredStiffness:
    """Torsional stiffness between two magnitudes of torque, N·m."""

    low: float
    high: float
    slope: Estimate  #: N·m/rad, the mean of both signs of torque


@dataclass(frozen=True, eq=False, slots=True)
class GearFigures:
    """Figures of a gear: angles in rad, torques in N·m."""

    rated_torque: float
    ramps: tuple[Ramps, ...]  #: ascending; hysteresis and friction are of the first, others last
    widths: tuple[Estimate, ...]  #: of the curve at zero torque, after each of the ramps
    friction: Estimate | None  #: half the width in torque, N·m; None without a complete loop
    middle_line: MiddleLine  #: the mean of the largest ramps
    backlash: Backlash  #: by all ramps together
    lost_motion: Estimate | None  #: at ± `LOST_MOTION_SHARE` of the rated torque, if reached
    stiffness: tuple[MeasuredStiffness, ...]  #: in the ranges covered, as the torque increases
    overall: Estimate | None  #: N·m/rad: slope of a line through each whole side of the loop

    @property
    def hysteresis(self) -> Estimate:
        """The width of the curve at zero torque."""
        return self.widths[0]

    @property
    def below_friction(self) -> bool:
        """Whether lost motion is read at a torque below the friction, so that play is hidden."""
        reading = LOST_MOTION_SHARE * self.rated_torque
        return self.friction is not None and reading < self.friction.value

    def listed(self) -> Iterator[Measured]:
        """Yield the figures in the order of reports."""
        at = number(LOST_MOTION_SHARE * self.rated_torque)
        yield Measured(HYSTERESIS, 'rad', self.hysteresis, ' at zero torque')
        yield Measured('backlash', 'rad', self.backlash)
        yield Measured('friction', 'N·m', self.friction)
        yield Measured(LOST_MOTION, 'rad', self.lost_motion, f' at ±{at} N·m')
        for stiffness in self.stiffness:
            ends = f'{number(stiffness.low)} to {number(stiffness.high)} N·m'
            yield Measured(f'stiffness {ends}', 'N·m/rad', stiffness.slope)
        yield Measured('overall stiffness', 'N·m/rad', self.overall)


def gear_figures(ramps: Sequence[Ramps], rated_torque: float | None = None) -> GearFigures:
    """Compute the figures of the ramps of a recording, in ascending order of amplitude.

    Without a rated torque, N·m, that is the amplitude of the largest ramps.

    Raises:
        RampError: if the angle does not grow with the torque.
    """
    # In smaller ramps, friction may hold the gear.
    ramps = [group for group in ramps if _moves(group)]
    if not ramps:
        raise RampError(
            'the angle does not grow with the torque: it stands still, or one of them has the '
            'wrong sign'
        )
    small, large = ramps[0], ramps[-1]
    rated = rated_torque or large.amplitude
    widths = [_hysteresis(group) for group in ramps]
    loaded = stiffness_of(large)
    # Where lost motion is read, or less if friction may keep small ramps from loading the spring.
    light = min(LOST_MOTION_SHARE * rated, (1.0 - MOST_FRICTION) * small.amplitude)
    bounds = [backlash_of(*pair, loaded, light) for pair in zip(ramps, widths, strict=True)]
    return GearFigures(
        rated,
        tuple(ramps),
        tuple(widths),
        _friction(small),
        mean_line(large),
        reconciled(bounds),
        _lost_motion(large, rated),
        _stiffness(large, rated),
        _overall(large),
    )


def _moves(ramps: Ramps) -> bool:
    """Whether the angle grows with the torque."""
    rises = [loop.fall.angle[0] - loop.rise.angle[0] for loop in ramps.loops]
    return float(np.mean(rises)) > _still(ramps)


def _still(ramps: Ramps) -> float:
    """Difference up to which two angles may be equal, rad."""
    greatest = max(float(np.max(np.abs(half.angle))) for half in ramps.halves)
    return max(ramps.step, _ROUNDING * greatest)


def _hysteresis(ramps: Ramps) -> Estimate:
    loops = ramps.loops
    return Estimate.of_mean(
        [loop.width(0.0) for loop in loops],
        _drifted(ramps),
        Component(math.sqrt(2.0) * resolution(ramps.step)),  # of two readings
        _rounded([loop.fall.rounding(0.0) - loop.rise.rounding(0.0) for loop in loops]),
    )


def _drifted(ramps: Ramps) -> Component:
    """Angle that an even drift of the zero adds between the halves of a loop, rad."""
    middles = [loop.middle(0.0) for loop in ramps.loops]
    count = len(middles)
    if count < 3:  # noqa: PLR2004, no line with a scatter
        return Component(0.0)
    per_loop = float(np.polynomial.polynomial.polyfit(range(count), middles, 1)[1])
    return Component(0.5 * per_loop, count - 2)


def _rounded(roundings: Sequence[float]) -> Component:
    """Take all errors up to the rounding of corners, rad, to be equally likely (GUM 4.3.7).

    Only the part that all repeats have in common counts, without what their scatter adds.
    """
    if len(roundings) < 2:  # noqa: PLR2004, nothing to compare
        return Component(0.0)
    square = float(np.mean(roundings)) ** 2 - float(np.var(roundings, ddof=1)) / len(roundings)
    return Component(math.sqrt(max(0.0, square) / 3.0))


def _friction(ramps: Ramps) -> Estimate | None:
    """Half the width of the loops in torque, at up to a quarter of their load, N·m.

    Its ± includes the difference from the friction at up to half of the load.
    """
    if not (lines := ramps.lines):
        return None
    near, far = (
        [line.friction_within(share * float(np.ptp(line.load))) for line in lines]
        for share in (0.125, 0.25)
    )
    uneven = float(np.mean(far) - np.mean(near)) / math.sqrt(3.0)
    stiffness = float(np.mean([np.ptp(line.load) / np.ptp(line.angle) for line in lines]))
    # Half the difference of two torques, read at many angles with the error of a step.
    steps = max(1.0, float(np.ptp(lines[0].angle)) / ramps.step) if ramps.step else 1.0
    reading = resolution(ramps.step) / math.sqrt(2.0 * steps)
    drifted = 0.5 * _drifted(ramps).standard
    others = (uneven, stiffness * math.hypot(reading, drifted))
    return Estimate.of_mean(near, *(Component(other, len(lines) - 1) for other in others))


def _gap(half: HalfLoop, torque: float) -> float:
    """Return by how much the angle differs between the levels around a torque, rad."""
    sign = 1.0 if half.rising else -1.0
    after = np.searchsorted(sign * half.torque, sign * torque).clip(1, len(half.angle) - 1)
    return float(half.angle[after] - half.angle[after - 1])


def _level_distance(ramps: Ramps) -> float:
    """Mean distance, N·m, of the levels around a torque, which may be steps of a staircase."""
    gaps = np.concatenate([np.abs(np.diff(half.torque)) for half in ramps.halves])
    return float(gaps @ gaps / gaps.sum())


def _lost_motion(ramps: Ramps, rated: float) -> Estimate | None:
    torque = LOST_MOTION_SHARE * rated
    sides = [
        [half for half in halves if half.reaches(torque) and half.reaches(-torque)]
        for halves in zip(*ramps.loops, strict=True)
    ]
    if not all(sides):
        return None
    angles = [[float(b.angle_at(torque) - b.angle_at(-torque)) for b in side] for side in sides]
    rounding = [b.rounding(torque) - b.rounding(-torque) for side in sides for b in side]
    reading = Component(resolution(ramps.step))  # the mean of two differences of two readings
    # Where the gear is alike in both directions, so are the errors of two of the four readings.
    gaps = [_gap(b, at) for side in sides for b in side for at in (torque, -torque)]
    gap = Component(math.sqrt(2.0) * resolution(float(np.sqrt(np.mean(np.square(gaps))))))
    return Estimate.of_sum([(0.5, side) for side in angles], reading, gap, _rounded(rounding))


# Stiffness


def _stiffness(ramps: Ramps, rated: float) -> tuple[MeasuredStiffness, ...]:
    reach, still, spacing = min(rated, ramps.amplitude), _still(ramps), _level_distance(ramps)
    corners = (corner for share in STIFFNESS_SHARES if (corner := share * rated) < reach)
    found = []
    for low, high in pairwise((0.0, *corners, reach)):
        if high < _LEAST_RANGE * low:
            break
        pulls = [pull for pull in ramps.pulls if all(_loads(half, low, ramps) for half in pull)]
        compliances, early, late = (
            np.array(
                [[_compliance(h, low + by, min(high, abs(h.end)) + by) for h in p] for p in pulls]
            )
            for by in (0.0, -0.5 * spacing, 0.5 * spacing)
        )
        # Otherwise friction holds the gear throughout.
        if len(compliances) and float(np.mean(compliances)) * (high - low) > still:
            steps = Component(math.sqrt(2.0) * resolution(ramps.step) / (high - low))
            # The torque at which play is crossed lies between two samples.
            between = Component(resolution(abs(float(np.mean(late) - np.mean(early)))))
            # By chance, two pairs often scatter far too little; both signs seldom do.
            sides = [(0.5, side) for side in compliances.T]
            slope = Estimate.of_sum(sides, steps, between).inverse()
            found.append(MeasuredStiffness(low, high, slope))
    return tuple(found)


def _overall(ramps: Ramps) -> Estimate | None:
    """Slope of the line through both halves of a side, from zero to the peak and back."""
    compliances: list[float] = []
    short: list[float] = []
    spacing = _level_distance(ramps)
    # Beside the greatest sample, smoothed, the peak lies between two samples.
    for less, found in ((0.0, compliances), (1.0, short)):
        positive: list[float] = []
        negative: list[float] = []
        for loading, unloading in ramps.sides:
            high = min(abs(loading.end), abs(unloading.start))
            high -= less * min(spacing + loading.blur, 0.5 * high)
            there, back = _compliance(loading, 0.0, high), _compliance(unloading, 0.0, high, -1.0)
            (positive if loading.rising else negative).append(0.5 * (there + back))
        found += [0.5 * sum(pair) for pair in zip(positive, negative, strict=False)]
        if not found or min(positive + negative) <= 0.0:
            return None
    peak = Component(abs(float(np.mean(compliances) - np.mean(short))) / math.sqrt(3.0))
    steps = Component(math.sqrt(2.0) * resolution(ramps.step) / ramps.amplitude)
    return Estimate.of_mean(compliances, peak, steps).inverse()


def _loads(half: HalfLoop, low: float, ramps: Ramps) -> bool:
    """Whether a half loop is like a full loading of these ramps from the torque `low` on.

    One that starts at a smaller peak is, beyond that peak, where hysteresis forgets it.
    """
    return abs(half.start) < low or abs(half.start) > 0.5 * ramps.amplitude


def _compliance(half: HalfLoop, low: float, high: float, side: float = 1.0) -> float:
    """Slope of the angle over a range of torque magnitudes, rad/(N·m).

    The range is on the side of the end of the half loop (`side` 1), or of its start (-1).
    """
    peak = half.end if side > 0.0 else half.start
    torque = math.copysign(1.0, peak) * np.linspace(low, high, _TORQUES)
    return float(np.polynomial.polynomial.polyfit(torque, half.angle_at(torque), 1)[1])

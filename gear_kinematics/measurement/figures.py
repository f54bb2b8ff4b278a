# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The figures of a hysteresis curve as catalogues give them; docs/lost_motion.md defines them."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from gear_kinematics.correction.uncertainty import Component, Estimate, resolution
from gear_kinematics.measurement.loops import Array, HalfLoop, Loop, RampError, Ramps
from gear_kinematics.measurement.measured import HYSTERESIS, Measured
from gear_kinematics.measurement.middle_line import (
    MOST_FRICTION,
    Backlash,
    MiddleLine,
    backlash_of,
    middle_lines,
    reconciled,
    stiffness_of,
)
from gear_kinematics.measurement.resolution import hidden_resolution, slope_resolution
from gear_kinematics.report.document import number

LOST_MOTION_SHARE = 0.03
"""Lost motion is measured between ± this share of the rated torque."""
STIFFNESS_SHARES = (0.15, 0.5)
"""Limits between the ranges of stiffness, as shares of the rated torque."""
_LEAST_RANGE = 1.5
"""Least ratio of the torques at the end and at the beginning of a range of stiffness."""
_ROUNDING = 1e-11
"""Relative rounding error of sums of many angles."""
_TORQUES = 200
"""At which a curve is compared with a straight line."""


@dataclass(frozen=True, slots=True)
class Stiffness:
    """Torsional stiffness, N·m/rad, between two magnitudes of torque, N·m."""

    low: float
    high: float
    both: Estimate
    """The mean of both signs of torque; the others are of one alone."""
    positive: Estimate
    negative: Estimate


@dataclass(frozen=True, slots=True)
class Settings:
    """Reference values of the figures: torques in N·m."""

    rated_torque: float
    corners: tuple[float, ...]
    """Ascending: limits between the ranges of stiffness."""
    small_load: float
    """At which lost motion without friction is read: as lost motion, unless friction may keep the
    smallest ramps from loading the spring so much."""
    angle_step: float
    """rad at the output, between readings of the encoder; 0 if unknown."""


@dataclass(frozen=True, eq=False, slots=True)
class Figures:
    """Of the ramps of one amplitude: angles in rad, torques in N·m."""

    settings: Settings
    ramps: Ramps
    hysteresis: Estimate
    """The width of the curve at zero torque."""
    friction: Estimate | None
    """Half the width of the curve in torque; None without a complete loop."""
    lost_motion: Estimate | None
    """Between the middles of the curve at ± `LOST_MOTION_SHARE` of the rated torque; None if the
    ramps are too small."""
    frictionless: Estimate | None
    """Lost motion without friction: between the ends of the middle line at ± the small load; None
    if a loop does not reach it."""
    backlash: Backlash | None
    """What these ramps leave room for; None if they do not bound it."""
    stiffness: tuple[Stiffness, ...]
    """In the ranges that the ramps cover, while the torque increases in magnitude."""
    overall: Stiffness | None
    """Slope of a straight line through each whole side of the loop."""

    def listed(self) -> Iterator[Measured]:
        """Yield the figures in the order of reports."""
        at = number(LOST_MOTION_SHARE * self.settings.rated_torque)
        load = number(self.settings.small_load)
        without = 'lost motion without friction'
        yield Measured(HYSTERESIS, 'rad', self.hysteresis, ' at zero torque')
        yield Measured('backlash', 'rad', self.backlash)
        yield Measured(without, 'rad', self.frictionless, f' at ±{load} N·m')
        yield Measured('friction', 'N·m', self.friction)
        yield Measured('lost motion', 'rad', self.lost_motion, f' at ±{at} N·m')
        for stiffness in self.stiffness:
            ends = f'{number(stiffness.low)} to {number(stiffness.high)} N·m'
            yield Measured(f'stiffness {ends}', 'N·m/rad', stiffness.both)
        overall = self.overall.both if self.overall else None
        yield Measured('overall stiffness', 'N·m/rad', overall)


@dataclass(frozen=True, eq=False, slots=True)
class GearFigures(Figures):
    """Of a gear: with friction from its smallest ramps, otherwise from its largest."""

    backlash: Backlash
    """What all ramps together leave room for."""
    by_amplitude: tuple[Figures, ...]
    """From small to large."""


def settings_for(
    ramps: Sequence[Ramps],
    angle_step: float,
    rated_torque: float | None = None,
    corners: Sequence[float] | None = None,
) -> Settings:
    """Choose the reference values of ramps, in ascending order of amplitude.

    Args:
        ramps: of one recording.
        angle_step: rad at the output; 0 if unknown.
        rated_torque: N·m; None: the amplitude of the largest ramps.
        corners: N·m, between ranges of stiffness; None: shares of the rated torque.
    """
    rated = rated_torque or ramps[-1].amplitude
    small = min(LOST_MOTION_SHARE * rated, (1.0 - MOST_FRICTION) * ramps[0].amplitude)
    shares = [share * rated for share in STIFFNESS_SHARES]
    return Settings(rated, tuple(sorted(corners or shares)), small, angle_step)


def gear_figures(ramps: Sequence[Ramps], settings: Settings) -> GearFigures:
    """Compute the figures of ramps, in ascending order of amplitude.

    Raises:
        RampError: if the angle does not grow with the torque.
    """
    ways = [loop.fall.angle[0] - loop.rise.angle[0] for loop in ramps[-1].loops]
    if float(np.mean(ways)) <= _still(ramps[-1], settings.angle_step):
        raise RampError(
            'the angle does not grow with the torque: it stands still, or one of them has the '
            'wrong sign'
        )
    loaded = stiffness_of(middle_lines(ramps[-1]), ramps[-1])
    found = tuple(_figures(group, settings, loaded) for group in ramps)
    small, large = found[0], found[-1]
    return GearFigures(
        settings,
        large.ramps,
        small.hysteresis,
        small.friction,
        large.lost_motion,
        next((figures.frictionless for figures in found if figures.frictionless), None),
        reconciled([figures.backlash for figures in found]),
        large.stiffness,
        large.overall,
        found,
    )


def _figures(ramps: Ramps, settings: Settings, loaded: float) -> Figures:
    """Figures of ramps of one amplitude, beside largest ones with a stiffness `loaded`."""
    lines, step = middle_lines(ramps), settings.angle_step
    hysteresis, frictionless = _hysteresis(ramps.loops, step), _frictionless(lines, settings)
    return Figures(
        settings,
        ramps,
        hysteresis,
        _friction(lines, ramps, step),
        _lost_motion(ramps.loops, settings),
        frictionless,
        backlash_of(lines, ramps, hysteresis, frictionless, step, loaded),
        _stiffness(ramps, settings),
        _overall(ramps),
    )


def _still(ramps: Ramps, angle_step: float) -> float:
    """Difference up to which two angles may be equal, rad."""
    greatest = max(float(np.max(np.abs(half.angle))) for half in ramps.halves)
    return max(angle_step, _ROUNDING * greatest)


def _hysteresis(loops: Sequence[Loop], angle_step: float) -> Estimate:
    widths = [loop.width(0.0) for loop in loops]
    return Estimate.of_mean(
        widths,
        _drifted(loops),
        Component(hidden_resolution(angle_step, widths, readings=2)),
        _rounded([loop.fall.rounding(0.0) - loop.rise.rounding(0.0) for loop in loops]),
    )


def _drifted(loops: Sequence[Loop]) -> Component:
    """What a zero that drifts evenly adds to the angle between the halves of a loop, rad."""
    middles = [loop.middle(0.0) for loop in loops]
    if len(loops) < 3:  # noqa: PLR2004, no line with a scatter
        return Component(0.0)
    per_loop = float(np.polynomial.polynomial.polyfit(range(len(loops)), middles, 1)[1])
    return Component(0.5 * per_loop, len(loops) - 2)


def _common_part(errors: Array) -> float:
    """Root mean square of what is the same in all repeats, without what scatter adds to it.

    Args:
        errors: (repeats, ...); a single repeat shows nothing.
    """
    count = len(errors)
    if count < 2:  # noqa: PLR2004, nothing to compare
        return 0.0
    scatter = float(np.mean(np.var(errors, axis=0, ddof=1))) / count
    return math.sqrt(max(0.0, float(np.mean(np.mean(errors, axis=0) ** 2)) - scatter))


def _rounded(roundings: Sequence[float]) -> Component:
    """Take errors up to the rounding of corners, rad, as equally likely (GUM 4.3.7)."""
    return Component(_common_part(np.array(roundings)) / math.sqrt(3.0))


def _friction(lines: Sequence[MiddleLine], ramps: Ramps, angle_step: float) -> Estimate | None:
    """Half the width of the loops in torque at up to a quarter of their load, N·m.

    Its ± contains how much that differs from the friction at up to half of the load.
    """
    if not lines:
        return None
    near, far = (
        [line.friction_within(share * float(np.ptp(line.load))) for line in lines]
        for share in (0.125, 0.25)
    )
    uneven = float(np.mean(far) - np.mean(near)) / math.sqrt(3.0)
    stiffness = float(np.mean([np.ptp(line.load) / np.ptp(line.angle) for line in lines]))
    # Half the difference of two torques, read at many angles that are off by the step.
    steps = max(1.0, float(np.ptp(lines[0].angle)) / angle_step) if angle_step else 1.0
    reading = stiffness * resolution(angle_step) / math.sqrt(2.0 * steps)
    drifted = 0.5 * stiffness * _drifted(ramps.loops).standard
    others = (uneven, math.hypot(reading, drifted))
    return Estimate.of_mean(near, *(Component(other, len(lines) - 1) for other in others))


def _lost_motion(loops: Sequence[Loop], settings: Settings) -> Estimate | None:
    torque = LOST_MOTION_SHARE * settings.rated_torque
    ways = [
        [half for half in halves if half.reaches(torque) and half.reaches(-torque)]
        for halves in zip(*loops, strict=True)
    ]
    if not all(ways):
        return None
    angles = [[float(b.angle_at(torque) - b.angle_at(-torque)) for b in way] for way in ways]
    readings = [Component(0.5 * hidden_resolution(settings.angle_step, a, 2)) for a in angles]
    rounding = [b.rounding(torque) - b.rounding(-torque) for way in ways for b in way]
    return Estimate.of_sum([(0.5, way) for way in angles], *readings, _rounded(rounding))


def _frictionless(lines: Sequence[MiddleLine], settings: Settings) -> Estimate | None:
    load = settings.small_load
    if not lines or any(min(line.load[-1], -line.load[0]) < load for line in lines):
        return None
    widths = [line.width(load) for line in lines]
    return Estimate.of_mean(widths, Component(hidden_resolution(settings.angle_step, widths, 4)))


# Stiffness


def _stiffness(ramps: Ramps, settings: Settings) -> tuple[Stiffness, ...]:
    corners = (0.0, *(corner for corner in settings.corners if corner < ramps.amplitude))
    found, still = [], _still(ramps, settings.angle_step)
    for low, high in pairwise((*corners, ramps.amplitude)):
        if high < _LEAST_RANGE * low:
            break
        pulls = [
            tuple(_compliance(half, low, min(high, abs(half.end))) for half in pull)
            for pull in ramps.pulls
            if all(_loads(half, low, ramps) for half in pull)
        ]
        if not pulls:
            continue
        least = float(np.min(np.mean(pulls, axis=0)))
        if least * (high - low) > still:  # else friction holds the gear throughout
            steps = slope_resolution(settings.angle_step, high - low, least)
            found.append(_of_sides(low, high, pulls, Component(steps, len(pulls) - 1)))
    return tuple(found)


def _of_sides(
    low: float, high: float, pairs: Sequence[tuple[float, ...]], *others: Component
) -> Stiffness:
    """From compliances under positive and negative torque; `both` is that of their mean."""
    positive, negative = zip(*pairs, strict=True)
    both = [0.5 * sum(pair) for pair in pairs]
    values = (Estimate.of_mean(c, *others).inverse() for c in (both, positive, negative))
    return Stiffness(low, high, *values)


def _overall(ramps: Ramps) -> Stiffness | None:
    """Slope of the line through both halves of a side, from zero to the peak and back."""
    positive: list[float] = []
    negative: list[float] = []
    for loading, unloading in ramps.sides:
        high = min(abs(loading.end), abs(unloading.start))
        there, back = _compliance(loading, 0.0, high), _compliance(unloading, 0.0, high, -1.0)
        (positive if loading.rising else negative).append(0.5 * (there + back))
    pairs = list(zip(positive, negative, strict=False))
    if not pairs or min(positive + negative) <= 0.0:
        return None
    return _of_sides(0.0, ramps.amplitude, pairs)


def _loads(half: HalfLoop, low: float, ramps: Ramps) -> bool:
    """Whether, from the torque `low` on, a half loop is like a full loading of these ramps.

    One from a smaller peak is so beyond that peak, where hysteresis has lost its memory of it.
    """
    return abs(half.start) < low or abs(half.start) > 0.5 * ramps.amplitude


def _compliance(half: HalfLoop, low: float, high: float, way: float = 1.0) -> float:
    """Slope of the line through the angles over the torques of a range, rad/(N·m).

    The torques are magnitudes: to the end of the half loop (way 1), or from its start (way -1).
    """
    peak = half.end if way > 0.0 else half.start
    torque = math.copysign(1.0, peak) * np.linspace(low, high, _TORQUES)
    return float(np.polynomial.polynomial.polyfit(torque, half.angle_at(torque), 1)[1])

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Hysteresis loops of torque ramps, found by the torque alone, and their middle lines.

At one angle, the torque exceeds the load on the spring by the friction while it rises, and falls
short of it by the friction while it falls. Half the sum of both is the load, and half the
difference the friction, whatever it depends on. What is left is the curve of a spring without
friction: the middle line.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import groupby, pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_MIN_ROWS = 25  # least number of rows of a half cycle
_MIN_SIGNAL_TO_NOISE = 5.0  # least peak of a half cycle, in standard deviations of the noise
_MIN_SHARE = 0.01  # share of the largest torque that a half cycle has to exceed
_EQUAL_TORQUES = 3.0  # standard deviations of the noise within which torques count as equal
_STRAIGHT = 3.0  # standard deviations of the noise up to which the end of a ramp is straight
_SMOOTHED = 0.01  # share of a ramp's amplitude to which a moving mean reduces the noise
ALIKE = 1.5  #: ratio up to which amplitudes of ramps count as equal
_ROUNDING = 1e-9  # relative differences of torques by rounding, as of a constant torque
_COMPLETE = 0.9  # share of the amplitude that both halves of a complete loop reach on both sides
ANGLES = 400  #: number of angles at which the middle line of a loop is known
_LOADS = 40  # number of loads at which its angle is read for a line through one side
SIDE = 0.1, 0.9
"""Part of either side of a middle line that friction at the reversals leaves, as shares of the
greatest load."""
MOST_FRICTION = 0.8  #: share of the torque beyond which friction hardly lets the spring be loaded


class RampError(ValueError):
    """A recording without usable torque ramps."""


@dataclass(frozen=True, eq=False, slots=True)
class HalfLoop:
    """Half of a hysteresis loop: from a torque peak to the opposite one."""

    torque: Array  #: (n,), N·m, strictly monotonic
    angle: Array  #: (n,), rad, at these torques
    noise: float  #: N·m, standard deviation of a reading of the torque
    blur: float  #: N·m, the same after smoothing

    @property
    def start(self) -> float:
        """N·m, the peak at which the half loop begins."""
        return float(self.torque[0])

    @property
    def end(self) -> float:
        """N·m, the peak at which it ends."""
        return float(self.torque[-1])

    @property
    def rising(self) -> bool:
        """Whether the torque increases."""
        return self.end > self.start

    def reaches(self, torque: float) -> bool:
        """Whether the half loop includes a torque, within the noise."""
        low, high = sorted((self.start, self.end))
        near = _EQUAL_TORQUES * self.noise
        return low - near <= torque <= high + near

    def angle_at(self, torque: Array | float) -> Array:
        """Return the angles at torques, rad, of the same shape."""
        sign = 1.0 if self.rising else -1.0
        return np.interp(sign * np.asarray(torque), sign * self.torque, self.angle)

    def rounding(self, torque: float) -> float:
        """Greatest error of the angle at a torque by noise, which rounds corners, rad."""
        before, at, after = self.angle_at(torque + 2.0 * self.blur * np.array([-1.0, 0.0, 1.0]))
        return float(0.5 * (before + after) - at)


class Loop(NamedTuple):
    """A hysteresis loop: two successive half loops."""

    fall: HalfLoop
    rise: HalfLoop

    @property
    def amplitude(self) -> float:
        """N·m, the smaller of the peaks at which the half loops begin."""
        return min(self.fall.start, -self.rise.start)

    @property
    def complete(self) -> bool:
        """Whether both halves go from peak to peak; a recording may end earlier."""
        return min(-self.fall.end, self.rise.end) >= _COMPLETE * self.amplitude

    @property
    def completed(self) -> 'Loop':
        """The loop of a gear that is alike in both directions: the longer half and its image."""
        half = max(self, key=lambda half: abs(half.end - half.start))
        angle = half.angle[0] + half.angle[-1] - half.angle
        image = replace(half, torque=-half.torque, angle=angle)
        return Loop(image, half) if half.rising else Loop(half, image)

    def width(self, torque: float) -> float:
        """The angle between the half loops, rad."""
        return float(self.fall.angle_at(torque) - self.rise.angle_at(torque))

    def middle(self, torque: float) -> float:
        """The angle midway between the half loops, rad."""
        return float(0.5 * (self.fall.angle_at(torque) + self.rise.angle_at(torque)))


@dataclass(frozen=True, eq=False, slots=True)
class MiddleLine:
    """Middle line of a loop, in the order of the angle: (n,) each, rad and N·m."""

    angle: Array
    load: Array  #: non-decreasing
    friction: Array

    @classmethod
    def of(cls, loop: Loop) -> 'MiddleLine':
        """Compute the middle line of a complete loop."""
        fall, rise = loop.fall, loop.rise
        paths = [
            (half.torque[::order], _monotonic(half.angle[::order]))
            for half, order in ((rise, 1), (fall, -1))
        ]
        low = max(angle[0] for _, angle in paths)
        high = min(angle[-1] for _, angle in paths)
        at = np.linspace(low, high, ANGLES)
        forth, back = (np.interp(at, _distinct(angle), torque) for torque, angle in paths)
        return cls(at, _monotonic(0.5 * (forth + back)), 0.5 * (forth - back))

    def angle_at(self, load: Array | float) -> Array:
        """Return the angles at loads, rad, of the same shape."""
        return np.asarray(np.interp(load, _distinct(self.load), self.angle))

    def width(self, load: float) -> float:
        """The angle between a load and the same load of the other sign, rad."""
        return float(self.angle_at(load) - self.angle_at(-load))

    def dead_band(self, low: float, high: float) -> tuple[float, float]:
        """Fit a straight line to each side, between two loads.

        Returns:
            The angle between them at no load, rad, and their mean compliance, rad/(N·m).
        """
        loads = np.linspace(low, high, _LOADS)
        (right, slope), (left, other) = (
            np.polynomial.polynomial.polyfit(loads, self.angle_at(sign * loads), 1)
            for sign in (1.0, -1.0)
        )
        return float(right - left), float(0.5 * (slope - other))

    def stiffness_within(self, width: float) -> float:
        """Mean stiffness over an angle about the middle, N·m/rad."""
        load = SIDE[0] * 0.5 * float(np.ptp(self.load))
        middle = 0.5 * float(self.angle_at(load) + self.angle_at(-load))
        ends = middle + 0.5 * width * np.array([-1.0, 1.0])
        return float(np.diff(np.interp(ends, self.angle, self.load))[0]) / width

    def friction_within(self, load: float) -> float:
        """Mean friction at loads up to one of either sign, N·m."""
        angles = self.angle_at(np.linspace(-load, load, _LOADS))
        return float(np.mean(np.interp(angles, self.angle, self.friction)))

    def friction_of_gap(self) -> float:
        """Return by how much the friction is greater below a tenth of the load, N·m."""
        reach = 0.5 * float(np.ptp(self.load))
        within = np.abs(self.load) < SIDE[0] * reach
        beyond = ~within & (np.abs(self.load) < MOST_FRICTION * reach)
        if not (within.any() and beyond.any()):
            return 0.0
        return float(np.mean(self.friction[within]) - np.mean(self.friction[beyond]))


@dataclass(frozen=True, eq=False)
class Ramps:
    """Ramps of one amplitude."""

    amplitude: float  #: N·m, the mean
    step: float  #: rad at the output, between readings of the encoder; 0 if unknown
    loops: tuple[Loop, ...]
    pulls: tuple[tuple[HalfLoop, HalfLoop], ...]  #: to the positive and to the negative peak
    sides: tuple[tuple[HalfLoop, HalfLoop], ...]  #: to a peak and back from it, in order of time

    @property
    def halves(self) -> list[HalfLoop]:
        """The halves of the loops."""
        return [half for loop in self.loops for half in loop]

    @cached_property
    def lines(self) -> list[MiddleLine]:
        """Middle lines of the complete loops, without those in which nothing moves."""
        lines = (MiddleLine.of(loop) for loop in self.loops if loop.complete)
        return [line for line in lines if np.ptp(line.angle) > 0.0]


def find_ramps(torque: Array, angle: Array, step: float = 0.0) -> tuple[Ramps, ...]:
    """Find the ramps in torques, N·m, and angles, rad, (n,) each, in ascending order of amplitude.

    The step between readings of the angle is in rad, 0 if unknown.

    Raises:
        RampError: if the torque never goes to both sides and back.
    """
    halves = _half_loops(torque, angle)
    # What preceded the first half loop is unknown, so that it belongs to no loop.
    pairs = zip(halves[1::2], halves[2::2], strict=False)
    loops = [Loop(b, a) if a.rising else Loop(a, b) for a, b in pairs]
    loops = [loop for loop in loops if all(half.reaches(0.0) for half in loop)]
    if not loops:
        raise RampError('no torque ramp that goes to one side, to the other and back to zero')
    groups: list[list[Loop]] = []
    for loop in sorted(loops, key=lambda loop: loop.amplitude):
        if groups and loop.amplitude <= ALIKE * groups[-1][0].amplitude:
            groups[-1].append(loop)
        else:
            groups.append([loop])
    return tuple(_ramps(group, loops, halves, step) for group in groups)


def _ramps(
    group: Sequence[Loop], loops: Sequence[Loop], halves: Sequence[HalfLoop], step: float
) -> Ramps:
    low, high = group[0].amplitude / ALIKE, group[-1].amplitude * ALIKE
    alike = [half for half in halves if low <= abs(half.end) <= high]
    rises, falls = ([half for half in alike if half.rising == up] for up in (True, False))
    return Ramps(
        float(np.mean([loop.amplitude for loop in group])),
        step,
        tuple(loop for loop in loops if loop in group),
        tuple(zip(rises, falls, strict=False)),
        tuple((there, back) for there, back in pairwise(halves) if there in alike),
    )


def _isotonic(values: Array) -> NDArray[np.intp]:
    """Find where the levels of the nearest non-decreasing sequence begin, and the end of the last.

    Neighbours in the wrong order are pooled (M. Ayer et al., Ann. Math. Statist. 26 (1955) 641).
    """
    least = _ROUNDING * float(np.max(np.abs(values)))
    levels: list[tuple[float, int]] = []  # mean and rows of each
    for value in values.tolist():
        mean, rows = value, 1
        while levels and levels[-1][0] >= mean - least:
            before, more = levels.pop()
            rows += more
            mean += (before - mean) * more / rows
        levels.append((mean, rows))
    return np.cumsum([0, *(rows for _, rows in levels)])


def _half_loops(torque: Array, angle: Array) -> list[HalfLoop]:
    if len(torque) < _MIN_ROWS:
        return []
    noise = _noise(torque)
    least = max(_MIN_SIGNAL_TO_NOISE * noise, _MIN_SHARE * float(np.max(np.abs(torque))))
    kernel = np.full(_MIN_ROWS, 1.0 / _MIN_ROWS)
    mean = np.convolve(np.pad(torque, _MIN_ROWS // 2, 'edge'), kernel, 'valid')
    turns = [
        rows.start + int(np.argmax(np.abs(_smooth(torque[rows], noise))))
        for rows in _half_cycles(mean, least)
    ]
    return [
        _half_loop(noise, torque[first : last + 1], angle[first : last + 1])
        for first, last in pairwise([0, *turns, len(torque) - 1])
        if last - first >= _MIN_ROWS
    ]


def _half_cycles(torque: Array, least: float) -> list[slice]:
    """Find the rows in which the torque is clear of zero, with alternating sign."""
    away = np.flatnonzero(np.abs(torque) > least)
    sides = np.split(away, np.flatnonzero(np.diff(np.sign(torque[away]))) + 1)
    sides = [side for side in sides if len(side) >= _MIN_ROWS]
    # Rows of the same sign become neighbours where a short part between them was dropped.
    return [
        slice(int(same[0][0]), int(same[-1][-1]) + 1)
        for _, group in groupby(sides, key=lambda side: torque[side[0]] > 0.0)
        if (same := list(group))
    ]


def _half_loop(noise: float, torque: Array, angle: Array) -> HalfLoop:
    smooth = _smooth(torque, noise)
    sign = 1.0 if smooth[-1] > smooth[0] else -1.0
    bounds = _isotonic(sign * smooth)
    blur = noise / math.sqrt(_mean_rows(torque, noise))
    levels, angles = (
        np.add.reduceat(values, bounds[:-1]) / np.diff(bounds) for values in (smooth, angle)
    )
    return HalfLoop(levels, angles, noise, blur)


def _noise(torque: Array) -> float:
    """Standard deviation of a reading, from second differences, which vanish on a ramp."""
    differences = np.abs(np.diff(torque, 2))
    return 1.4826 * float(np.median(differences)) / math.sqrt(6.0)  # that of the median deviation


def _smooth(torque: Array, noise: float) -> Array:
    """Smooth a ramp by a moving mean, and by a straight line at the ends, where it has none."""
    rows, tenth = _mean_rows(torque, noise), len(torque) // 10
    edge = rows // 2
    sums = np.concatenate([[0.0], np.cumsum(torque)])
    smooth = torque.copy()
    smooth[edge : len(torque) - edge] = (sums[rows:] - sums[:-rows]) / rows
    if not noise:
        return smooth
    for end, half in (
        (slice(tenth), slice(tenth // 2)),
        (slice(-tenth, None), slice(-tenth // 2, None)),
    ):
        line = _line(torque[end])
        if np.std(torque[end] - line) <= _STRAIGHT * noise:  # not the end of a staircase
            smooth[half] = line[half]
    return smooth


def _mean_rows(torque: Array, noise: float) -> int:
    """Return the rows of the moving mean: no more than needed, as a ramp may pause."""
    enough = (noise / (_SMOOTHED * 0.5 * float(np.ptp(torque)))) ** 2 if noise else 0.0
    return 2 * (int(min(enough, len(torque) // 10)) // 2) + 1


def _line(values: Array) -> Array:
    rows = np.arange(len(values)) - 0.5 * (len(values) - 1)
    return np.asarray(np.mean(values) + rows @ values / (rows @ rows) * rows)


def _monotonic(values: Array) -> Array:
    """Return a non-decreasing sequence: the mean of the greatest before and the least after."""
    reached = np.maximum.accumulate(values)
    left: Array = np.minimum.accumulate(values[::-1])[::-1]
    return 0.5 * (reached + left)


def _distinct(values: Array) -> Array:
    """Make equal values differ in their order, by rounding errors of the greatest."""
    apart: Array = np.spacing(np.max(np.abs(values))) * np.arange(len(values))
    return values + apart

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The transmission error of a recording over the output angle: accuracy and lost motion."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.correction.reversals import Pair, Reversals, separate
from gear_kinematics.correction.transmission_error import Direction
from gear_kinematics.measurement.recording import Encoders
from gear_kinematics.statistics.uncertainty import Component, Estimate, resolution

Array = NDArray[np.float64]

_ANGLES = 200
"""At which two runs over the same range are compared."""
_MIN_SHARE = 0.5
"""Runs of at least this share of the longest one are repeats of it."""


@dataclass(frozen=True, eq=False, slots=True)
class TransmissionFigures:
    """Results from a recording of both encoders: angles in rad."""

    travel: float
    """From the least to the greatest output angle."""
    offset: float
    """The mean error: the offset of the encoders' zeros."""
    forward: Estimate | None
    """Transmission accuracy: peak-to-peak error of forward motion without a reversal."""
    backward: Estimate | None
    reversals: Estimate | None
    """Error of the backward minus the forward run at the same angles; None without any."""
    lost_motion: Estimate | None
    """The same at no speed; None where it cannot be told from a delay. Neither is told whose ±
    exceeds itself and the whole error in one direction."""
    delay: Estimate | None
    """s, or rows of a file without times, by which the stamps of the output are late; None if it
    cannot be told. The other figures are without it."""
    error: Array
    """(n,), measured minus ideal."""
    angle: Array
    """(n,), ideal, of the output."""
    direction: NDArray[np.int8]
    """(n,): 1, -1, or 0 where unknown."""


class _Run:
    """Samples in one direction, in the order of the angle."""

    def __init__(self, angle: Array, error: Array, speed: Array) -> None:
        order = np.argsort(angle, kind='stable')
        self.angle, self.error, self._speed = angle[order], error[order], speed[order]
        self.low, self.high = float(self.angle[0]), float(self.angle[-1])
        self.travel = self.high - self.low

    def mean_speed(self, edges: Array) -> Array:
        """Mean speeds between angles (n,): (n - 1,)."""
        sums = np.concatenate([[0.0], np.cumsum(self._speed)])
        rows = np.searchsorted(self.angle, edges)
        counts = np.diff(rows)
        single = np.interp(0.5 * (edges[1:] + edges[:-1]), self.angle, self._speed)
        return np.where(counts, np.diff(sums[rows]) / np.maximum(counts, 1), single)


class _Motion:
    """The transmission error along the runs between reversals."""

    def __init__(self, encoders: Encoders, ratio: Fraction, travel: float) -> None:
        ideal = encoders.ideal(ratio)
        self.angle = encoders.at_measured(ideal)
        self.error = encoders.error(ratio)
        direction = Direction(travel)
        starts = set(encoders.starts(None).tolist())
        way = np.zeros(len(ideal), np.int8)
        for row, step in enumerate(np.diff(ideal, prepend=ideal[0]).tolist()):
            if row in starts:
                direction.reset()
            way[row] = direction.move(step)
        after = way[np.minimum(encoders.before + (encoders.share > 0.0), len(way) - 1)]
        self.direction = np.where(way[encoders.before] == after, after, 0).astype(np.int8)
        self._speed = encoders.speed(ratio)

    def runs(self) -> Iterator[tuple[int, _Run]]:
        """Yield the runs between reversals, each with its direction."""
        known = np.flatnonzero(self.direction)
        signs = self.direction[known]
        for rows in np.split(known, np.flatnonzero(np.diff(signs)) + 1):
            if len(rows) > 1:
                run = _Run(self.angle[rows], self.error[rows], self._speed[rows])
                yield int(self.direction[rows[0]]), run

    def long_runs(self, way: int) -> list[_Run]:
        """Return the runs in a direction that are repeats of the longest."""
        runs = [run for sign, run in self.runs() if sign == way]
        longest = max((run.travel for run in runs), default=0.0)
        return [run for run in runs if run.travel >= _MIN_SHARE * longest]


def transmission_figures(
    encoders: Encoders, ratio: Fraction, travel: float
) -> TransmissionFigures:
    """Compute the figures of a recording, less a delay that is clear.

    Args:
        encoders: of rotor and output.
        ratio: of the gear.
        travel: rad of the output after a reversal until the new direction counts.
    """
    both = Component(math.sqrt(2.0) * resolution(encoders.error_step(ratio).size))
    motion = _Motion(encoders, ratio, travel)
    found = _reversals(motion, both)
    if found and found.delay and found.delay.clear:
        # The error is in proportion to the delay only as long as the speed hardly changes in it.
        shift = found.delay.value
        motion = _Motion(encoders.earlier(shift), ratio, travel)
        if (rest := _reversals(motion, both)) and rest.delay:
            late = replace(rest.delay, value=shift + rest.delay.value)
            found = replace(found, lost_motion=rest.lost_motion, delay=late)
    forward, backward = (_accuracy(motion.long_runs(way), both) for way in (1, -1))
    error = max(one.value if one else 0.0 for one in (forward, backward))
    return TransmissionFigures(
        float(np.ptp(motion.angle)),
        float(np.mean(motion.error)),
        forward,
        backward,
        _told(found.difference, error) if found else None,
        _told(found.lost_motion, error) if found else None,
        found.delay if found else None,
        motion.error,
        motion.angle,
        motion.direction,
    )


def _told(lost: Estimate | None, error: float) -> Estimate | None:
    """A difference between directions, unless its ± exceeds it and the error in either."""
    beyond = lost and math.inf > lost.expanded > max(abs(lost.value), error)
    return None if beyond else lost


def _accuracy(runs: Sequence[_Run], reading: Component) -> Estimate | None:
    values = [float(np.ptp(run.error)) for run in runs]
    return Estimate.of_mean(values, reading) if values else None


def _reversals(motion: _Motion, reading: Component) -> Reversals | None:
    """Compare successive runs, in pairs of opposite direction, over their common angles."""
    pairs = [_pair(*two) for two in list(pairwise(motion.runs()))[::2]]
    return separate(pairs, reading)


def _pair(first: tuple[int, _Run], second: tuple[int, _Run]) -> Pair:
    (sign, there), (_, back) = first, second
    low, high = max(there.low, back.low), min(there.high, back.high)
    if low >= high:
        return Pair(np.zeros(0), np.zeros(0))
    edges = np.linspace(low, high, _ANGLES + 1)
    at = 0.5 * (edges[1:] + edges[:-1])
    there_error, back_error = (np.interp(at, run.angle, run.error) for run in (there, back))
    speed = there.mean_speed(edges) - back.mean_speed(edges)
    return Pair(sign * (back_error - there_error), sign * speed)

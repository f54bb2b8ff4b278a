"""A zero that drifts, as by warming up: what changes slowly or evenly from loop to loop.

On the way up, and on the way down, a gear passes a torque at the same angle in each loop, but for
its zero, and for its friction if that differs from loop to loop.
"""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from gear_kinematics.lost_motion.static.ramps import Array, HalfLoop, Ramps

_LEAST_LOOPS = 3
"""Number of loops in which an even drift shows; an uneven one needs one more."""
_LEVELS = 10
"""Torques at which loops are compared."""
_REACH = 0.95
"""Share of the least peak up to which they are."""
_KNOTS = 4
"""Knots of the zero for each loop, between which it moves evenly."""
_MOST_KNOTS = 60
_STIFFNESSES = (1e4, 1e2, 1.0)
"""Weights of the bends at the knots."""
_RIDGE = 1e-6
"""Weight that decides between equal fits."""
_CLEARLY = 0.4
"""A drift is taken out if it leaves less than this share of the squares of the changes."""


@dataclass(frozen=True, eq=False, slots=True)
class Drift:
    """A zero that moves slowly."""

    rate: float
    """rad/s, from the first to the last loop."""
    steady: bool
    """Whether it moves evenly."""
    time: Array
    """(knots,), s."""
    zero: Array
    """(knots,), rad."""

    def at(self, time: Array) -> Array:
        """Return the zero at times, (n,), rad."""
        ends = [
            self.zero[k] + (time - self.time[k]) * self._slope(k) for k in (0, len(self.time) - 1)
        ]
        inside = np.interp(time, self.time, self.zero)
        return np.where(
            time < self.time[0], ends[0], np.where(time > self.time[-1], ends[1], inside)
        )

    def _slope(self, end: int) -> float:
        beside = 1 if end == 0 else end - 1
        return float((self.zero[beside] - self.zero[end]) / (self.time[beside] - self.time[end]))


def drift_of(ramps: Ramps) -> Drift | None:
    """Find how the zero moves; None if not evenly or slowly."""
    if len(ramps.loops) < _LEAST_LOOPS:
        return None
    passages = _Passages(ramps)
    time = passages.knots
    count = len(time)
    still, line = _Zero(np.empty((count, 0))), _Zero((time - np.mean(time))[:, None])
    kept, missed = still, passages.missed(still)
    uneven = _STIFFNESSES if len(ramps.loops) > _LEAST_LOOPS else ()
    for zero in (line, *(_Zero(np.eye(count), stiffness) for stiffness in uneven)):
        fewer = passages.missed(zero)
        gain = missed - fewer
        error = float(np.std(gain, ddof=1)) / math.sqrt(len(gain))
        if np.mean(gain) > error and np.sum(fewer) < _CLEARLY * np.sum(missed):
            kept, missed = zero, fewer
    if kept is still:
        return None
    values = passages.fitted(kept)
    rate = float((values[-1] - values[0]) / (time[-1] - time[0]))
    return Drift(rate, kept is line, time, values)


class _Zero(NamedTuple):
    """How a zero may move."""

    basis: Array
    """(knots, parameters)."""
    stiffness: float = 0.0
    """Weight of the bends at the knots."""


class _Passages:
    """The angles at which half loops pass torques, as linear equations for the zero.

    Unknown are the zero at its knots, the angle of either way at each torque, and by how much
    friction holds back both ways of each loop.
    """

    def __init__(self, ramps: Ramps) -> None:
        """Take torques that all loops reach."""
        count = len(ramps.loops)
        reach = _REACH * min(loop.amplitude for loop in ramps.loops)
        torques = np.linspace(-reach, reach, _LEVELS)
        found = [
            (loop, way, level, float(half.time_at(torque)), float(half.angle_at(torque)))
            for loop, both in enumerate(ramps.loops)
            for way, half in enumerate((both.fall, both.rise))
            for level, torque in enumerate(torques.tolist())
            if half.reaches(torque)
        ]
        loop, way, level = np.array([row[:3] for row in found]).T
        time, self._angle = np.array([row[3:] for row in found]).T
        self.knots = np.linspace(min(time), max(time), min(_KNOTS * count, _MOST_KNOTS) + 1)
        self._half = 2 * loop + way
        apart = np.abs(np.subtract.outer(time, self.knots)) / (self.knots[1] - self.knots[0])
        self._at_knots = np.maximum(0.0, 1.0 - apart)
        angle = np.eye(2 * _LEVELS)[way * _LEVELS + level]
        friction = (1.0 - 2.0 * way)[:, None] * np.eye(count)[loop]
        self._fixed = np.hstack([angle, friction])

    def missed(self, zero: _Zero) -> Array:
        """Mean square error of each half loop, predicted by the others, rad²."""
        columns, solution = self._solution(zero)
        rest = self._angle - columns @ (solution @ self._angle)
        found = []
        for half in np.unique(self._half):
            own = np.flatnonzero(self._half == half)
            # What a fit without these rows misses follows from the fit to all of them.
            others = np.eye(len(own)) - columns[own] @ solution[:, own]
            found.append(np.mean(np.linalg.solve(others, rest[own]) ** 2))
        return np.array(found)

    def fitted(self, zero: _Zero) -> Array:
        """Return the zero at the knots, rad."""
        _, solution = self._solution(zero)
        return np.asarray(zero.basis @ (solution @ self._angle)[self._fixed.shape[1] :])

    def _solution(self, zero: _Zero) -> tuple[Array, Array]:
        """Return the columns of the equations, and the matrix that solves them."""
        columns = np.hstack([self._fixed, self._at_knots @ zero.basis])
        bends = math.sqrt(zero.stiffness) * np.diff(zero.basis, 2, axis=0)
        matrix = columns.T @ columns + _RIDGE * np.eye(columns.shape[1])
        own = slice(self._fixed.shape[1], None)
        matrix[own, own] += bends.T @ bends
        return columns, np.linalg.solve(matrix, columns.T)


def without_drift(ramps: Ramps, drift: Drift) -> Ramps:
    """Return the ramps as from a zero that stands still."""

    def still(half: HalfLoop) -> HalfLoop:
        return replace(half, angle=half.angle - drift.at(half.times) + float(np.mean(drift.zero)))

    return ramps.changed(still)

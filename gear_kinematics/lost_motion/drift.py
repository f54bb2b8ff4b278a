"""A zero that drifts, as by warming up: what changes slowly or evenly from loop to loop."""

import math
from dataclasses import dataclass, replace

import numpy as np

from gear_kinematics.lost_motion.ramps import Array, HalfLoop, Loop, Ramps

_LEAST_LOOPS = 3
"""Number of loops in which a drift shows."""
_LEVELS = 100
"""Torques at which the middle of a loop is taken."""
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
    """(loops,), s, of the middles of the loops."""
    zero: Array
    """(loops,), rad."""

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
    """Find how the middles of the loops move; None if not evenly or slowly."""
    count = len(ramps.loops)
    if count < _LEAST_LOOPS:
        return None
    zero = np.array([_middle(loop) for loop in ramps.whole])
    time = np.reshape([_time_at_zero(half) for half in ramps.halves()], (count, 2)).mean(axis=1)
    missed = np.square([_missed(time, zero, k) for k in range(count)])
    kept = 0
    for way in (1, 2):
        gain = missed[:, kept] - missed[:, way]
        error = float(np.std(gain, ddof=1)) / math.sqrt(count)
        if np.mean(gain) > error and np.sum(missed[:, way]) < _CLEARLY * np.sum(missed[:, kept]):
            kept = way
    if not kept:
        return None
    if kept == 1:
        zero = np.polynomial.Polynomial.fit(time, zero, 1)(time)
    rate = float((zero[-1] - zero[0]) / (time[-1] - time[0]))
    return Drift(rate, kept == 1, time, zero)


def _missed(time: Array, zero: Array, own: int) -> list[float]:
    """Errors of a loop's middle by the others: their mean, their line, and the neighbours'."""
    others = np.delete(np.arange(len(time)), own)
    near = others[:2] if own == 0 else others[-2:] if own == len(time) - 1 else [own - 1, own + 1]
    off = time - time[own]
    lines = [
        np.polynomial.polynomial.polyfit(off[rows], zero[rows], 1)[0] for rows in (others, near)
    ]
    return [float(zero[own] - value) for value in (np.mean(zero[others]), *lines)]


def _middle(loop: Loop) -> float:
    """Mean angle of a loop over the torques of both halves, rad."""
    reach = min(loop.fall.start, -loop.fall.end, -loop.rise.start, loop.rise.end)
    torque = np.linspace(-reach, reach, _LEVELS) if reach > 0.0 else np.zeros(1)
    return 0.5 * float(np.mean(loop.fall.angle_at(torque) + loop.rise.angle_at(torque)))


def _time_at_zero(half: HalfLoop) -> float:
    sign = 1.0 if half.rising else -1.0
    return float(np.interp(0.0, sign * half.torque, half.times))


def without_drift(ramps: Ramps, drift: Drift) -> Ramps:
    """Return the ramps as from a zero that stands still."""

    def still(half: HalfLoop) -> HalfLoop:
        return replace(half, angle=half.angle - drift.at(half.times) + float(np.mean(drift.zero)))

    return ramps.changed(still)

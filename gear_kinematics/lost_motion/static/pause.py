"""Pauses of the torque at the peaks of ramps, in which the gear stands still."""

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from gear_kinematics.lost_motion.static.ramps import Array, HalfLoop, Ramps
from gear_kinematics.lost_motion.static.rate import rate_of

STANDSTILL = 1.5
"""The torque goes back by this times the friction while the gear certainly stands still."""
_WINDOW = 0.15
"""Share of a ramp's amplitude, before and after a reversal, in which corners are found."""
SHARP = 0.5
"""Share of the time in which the torque changes by a window, up to which it does not pause."""
_EDGES = 0.1
"""Share of a pause, at either end, in which the gear may not stand still yet or any longer."""
_CONSTANT = 0.02
"""Share of the friction up to which the torque is constant."""
_BY_NOISE = 4.0
"""Standard deviations of the mean of a third by which others may differ."""
_ROWS = 30
"""Least number of samples of a pause."""


def window_of(ramps: Ramps, friction: float) -> float:
    """Return by how much the torque changes beside a corner while its ramp is straight, N·m."""
    return min(_WINDOW * ramps.amplitude, STANDSTILL * friction)


def reversals(ramps: Ramps) -> Iterator[tuple[HalfLoop, HalfLoop]]:
    """Yield the half loops of ramps after those that end where they begin."""
    own = {id(half) for half in ramps.halves()}
    return (pair for pair in pairwise(ramps.history) if id(pair[1]) in own)


def pause_between(before: HalfLoop, half: HalfLoop, window: float) -> tuple[float, float]:
    """Return when the torque arrives at a peak and when it departs from it, s.

    Args:
        before: the half loop that ends at the peak.
        half: the one that begins there.
        window: N·m, by which the torque changes on either side.
    """
    levels = half.start - np.sign(half.start) * window * np.array([0.5, 1.0])
    (last, earlier), (first, later) = before.time_at(levels), half.time_at(levels)
    return float(2.0 * last - earlier), float(2.0 * first - later)


def pauses_of(
    time: Array, torque: Array, angle: Array, ramps: Ramps, friction: float
) -> Iterator[tuple[Array, Array]]:
    """Yield times, s, and angles, rad, in which the torque pauses at a peak.

    Args:
        time: (n,), s, ascending.
        torque: (n,), N·m.
        angle: (n,), rad.
        ramps: of one amplitude, found in them.
        friction: N·m.
    """
    rate, window = rate_of(ramps), window_of(ramps, friction)
    for before, half in reversals(ramps):
        arrival, departure = pause_between(before, half, window)
        length = departure - arrival
        edge = _EDGES * length
        rows = slice(*np.searchsorted(time, [arrival + edge, departure - edge]))
        if not rate or length < SHARP * window / rate.rate or len(time[rows]) < _ROWS:
            continue
        thirds = [np.mean(part) for part in np.array_split(torque[rows], 3)]
        by_noise = _BY_NOISE * half.noise / math.sqrt(len(time[rows]) / 3)
        if np.ptp(thirds) < max(_CONSTANT * friction, by_noise):
            yield time[rows], angle[rows]

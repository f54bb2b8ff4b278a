# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Separation of lost motion on reversals from a delay between the stamps of the encoders.

Both make the error of backward motion exceed that of forward motion at the same output angle. Lost
motion does so by a constant, a delay τ in proportion to the speed: an output angle that is stamped
late by τ lags by its speed times τ. So over the common angles

    error backward - error forward = lost motion + τ (speed forward - speed backward)

which is a straight line over the difference of the signed speeds.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.statistics.uncertainty import Component, Estimate, jackknife

Array = NDArray[np.float64]

_BLOCKS = 20
"""Blocks of a pair of runs. Errors within a block may be correlated, those of blocks are not."""
_PAIRS = 4
"""Least number of pairs of runs that serve as the repeats instead of blocks of angles."""
_LEAST = 3
"""Least number of blocks that a straight line and its scatter need."""
_SPREAD = 0.01
"""Least standard deviation of the speed, relative to its mean, that makes a delay measurable."""
_STEADY = 0.02
"""Greatest share of the speed's variance that may be noise; it makes the delay too small."""


@dataclass(frozen=True, slots=True)
class Reversals:
    """Differences between both directions of motion."""

    difference: Estimate
    """Mean error of backward minus forward motion, rad: lost motion, and delay times speed."""
    lost_motion: Estimate | None
    """Lost motion, rad; None if the speed varies too little to separate it from a delay."""
    delay: Estimate | None
    """Delay of the stamps of the measured angles, s; None in the same case."""


class Pair(NamedTuple):
    """A run and the next one back, at angles that both cover, in the order of the angles."""

    difference: Array
    """Error of backward minus forward motion, (n,), rad."""
    speed: Array
    """Speed of forward minus that of backward motion, (n,), rad/s."""


def separate(pairs: Sequence[Pair], *others: Component) -> Reversals | None:
    """Separate lost motion from a delay.

    Uncertainties are those of the jackknife, which leaves out a pair at a time, or a block of
    angles where there are few pairs.

    Args:
        pairs: pairs of runs; those without angles are ignored.
        others: components of the uncertainty that all pairs have in common, rad.

    Returns:
        None without common angles.
    """
    pairs = [pair for pair in pairs if len(pair.difference)]
    if not pairs:
        return None
    blocks = [_blocks(pair) for pair in pairs]
    groups = blocks if len(blocks) >= _PAIRS else [row[None] for rows in blocks for row in rows]
    rows = np.concatenate(groups)
    centre = np.average(rows[:, 1:], axis=0, weights=rows[:, 0])
    sums = np.array([_moments(rows, centre) for rows in groups])
    whole = sums.sum(axis=0, keepdims=True)
    sums = np.concatenate([whole, whole - sums]) if len(groups) > 1 else whole
    # Without each group: means of difference and speed, variance of the speed, slope.
    difference, speed, square, product = sums.T[1:] / sums.T[0]
    variance = square - speed * speed
    covariance = product - speed * difference
    difference, speed = difference + centre[0], speed + centre[1]

    def estimate(fits: Array, *others: Component) -> Estimate:
        return replace(jackknife(fits, *others, corrected=True), repeats=len(pairs))

    mean = estimate(difference, *others)
    noise = float(np.mean([_noise(pair) for pair in pairs]))
    # Whether the speed varies, and not only by noise.
    varies = (variance > (_SPREAD * speed) ** 2) & (noise <= _STEADY * variance)
    if len(groups) <= _LEAST or not varies.all():
        return Reversals(mean, None, None)
    slope = covariance / variance
    return Reversals(mean, estimate(difference - slope * speed, *others), estimate(slope))


def _blocks(pair: Pair) -> Array:
    """Number of angles, and means of difference and speed, in blocks of neighbouring angles."""
    values = np.stack([np.ones(len(pair.speed)), pair.difference, pair.speed], axis=1)
    rows = np.array_split(values, min(_BLOCKS, len(values)))
    return np.array([[len(row), *row[:, 1:].mean(axis=0)] for row in rows])


def _moments(rows: Array, centre: Array) -> Array:
    """Sums over blocks, from a centre: of 1, difference, speed, its square, their product."""
    difference, speed = (rows[:, 1:] - centre).T
    terms = np.stack([np.ones(len(rows)), difference, speed, speed * speed, speed * difference])
    return np.asarray(terms @ rows[:, 0])


def _noise(pair: Pair) -> float:
    """Variance of the noise in the mean speed of a block, from its second differences."""
    if len(pair.speed) <= _LEAST:
        return 0.0
    in_block = max(1.0, len(pair.speed) / _BLOCKS)
    return float(np.mean(np.diff(pair.speed, 2) ** 2)) / 6.0 / in_block

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Causes of deviations: an offset, another mechanism, unit or shaft."""

import math
from fractions import Fraction

import numpy as np

from gear_kinematics.kinematics import Gear, Mechanism
from gear_kinematics.kinematics.gear_ratio import tooth_pairs
from gear_kinematics.statistics.uncertainty import Component, Estimate, jackknife
from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.fields import Array, product
from gear_kinematics.validation.report import Finding

_MAX_TEETH = 1000
_MAX_DENOMINATOR, _CHANCE = 100, 0.01
_MIN_TURNING = 0.1  # rad of the rotor, to determine a ratio
_BLOCKS, _MIN_BLOCKS = 32, 4
_ROUNDING = 5.1e-10  # relative standard uncertainty due to the rounding of the sums
_CLEAR_DEVIATION = 2.0  # deviation that is clear, in expanded uncertainties
_MAX_SCATTER = 1e-5  # greatest relative deviation of all values together from a constant factor


class AngleFit:
    """Slope of recorded output angles over rotor angles, and their mean error, from running sums.

    Uncertainties are those of the jackknife over blocks of successive samples. The slope is taken
    within blocks, so that a step of the angle, as by homing, changes the offset alone.
    """

    def __init__(self) -> None:
        self.count = 0
        self.lowest_error, self.highest_error = math.inf, -math.inf
        self._origin = (0.0, 0.0)
        self._sums: list[Array] = []  # sums of 1, x, y, x², xy and error over parts of batches

    def update(self, rotor_angle: Array, recorded: Array, error: Array) -> None:
        """Add samples (n,), rad; `error` is recorded minus recomputed."""
        if not len(recorded):
            return
        if not self.count:
            self._origin = (float(rotor_angle[0]), float(recorded[0]))
        self.count += len(recorded)
        self.lowest_error = min(self.lowest_error, float(error.min()))
        self.highest_error = max(self.highest_error, float(error.max()))
        with np.errstate(over='ignore', invalid='ignore'):  # garbage has no slope
            x, y = rotor_angle - self._origin[0], recorded - self._origin[1]
            terms = np.ones_like(x), x, y, x * x, x * y, error
            self._sums.append(np.stack([_in_blocks(term) for term in terms]))

    def offset(self, tolerance: float) -> float | None:
        """Return the constant offset of all errors, rad, or None if they are not constant."""
        if not self.count or self.highest_error - self.lowest_error > 2.0 * tolerance:
            return None
        offset = 0.5 * (self.lowest_error + self.highest_error)
        return offset if abs(offset) > tolerance else None

    def mean_error(self) -> Estimate | None:
        """Return the mean error, rad; None for too few samples."""
        count, *_, error = self._blocks()
        return _ratio_of_sums(error, count)

    def slope(self) -> Estimate | None:
        """Return output angle / rotor angle; None without motion, or for garbage."""
        with np.errstate(over='ignore', invalid='ignore'):
            n, x, y, xx, xy, _ = self._blocks()
            within = xx - x * x / n
            if not within.sum() >= self.count * (_MIN_TURNING / _BLOCKS) ** 2:
                return None
            found = _ratio_of_sums(xy - x * y / n, within)
        return None if found is None or _is_near(found, 0.0) else found

    def _blocks(self) -> Array:
        return _in_blocks(np.concatenate(self._sums or [np.zeros((6, 0))], axis=1))


def _in_blocks(values: Array) -> Array:
    """Sum values, (..., n), over at most _BLOCKS blocks of successive ones."""
    count = values.shape[-1]
    starts = np.arange(0, count, -(-count // _BLOCKS) or 1)
    return np.add.reduceat(values, starts, axis=-1) if count else values


def _ratio_of_sums(above: Array, below: Array) -> Estimate | None:
    if len(above) < _MIN_BLOCKS:
        return None
    with np.errstate(over='ignore', invalid='ignore', divide='ignore'):
        whole = float(above.sum() / below.sum())
        fits = np.array([whole, *(above.sum() - above) / (below.sum() - below)])
    if not np.isfinite(len(fits) * fits).all():
        return None
    return jackknife(fits, Component(_ROUNDING * abs(whole)))


def _is_near(found: Estimate, other: float) -> bool:
    """Return whether a value deviates too little from another one to be clearly different."""
    return abs(found.value - other) <= _CLEAR_DEVIATION * found.expanded


def _written(found: Estimate) -> str:
    return f'{found.value:.9g} ± {found.uncertainty:.2g}'


def diagnose(gear: Gear, fit: AngleFit, tolerance: float) -> Finding | None:
    """Find a systematic deviation of the output angles from a gear's, beyond a tolerance, rad."""
    offset = fit.offset(tolerance)
    if offset is not None:
        return Finding(FindingCause.OFFSET, values={'offset': offset}, explains=True)
    slope = fit.slope()
    if slope is None:
        return None
    if not _is_near(slope, float(1 / gear.gear_ratio)):
        return _another_ratio(gear, slope)
    mean = fit.mean_error()
    if mean and abs(mean.value) > tolerance and not _is_near(mean, 0.0):
        values = {'mean': _written(mean), 'lowest': fit.lowest_error, 'highest': fit.highest_error}
        return Finding(FindingCause.MEAN_OFFSET, values=values, explains=True)
    return None


def _another_ratio(gear: Gear, slope: Estimate) -> Finding:
    cause, spread = FindingCause.ANOTHER_RATIO, _CLEAR_DEVIATION * slope.expanded
    values = {'ratio': _as_fraction(slope.inverse()), 'expected': str(gear.gear_ratio)}
    if _is_near(slope, -float(1 / gear.gear_ratio)):
        cause = FindingCause.SIGN_FLIPPED
    elif isinstance(gear, Mechanism) and (pair := _tooth_pair(gear, abs(slope.value), spread)):
        cause = FindingCause.ANOTHER_TOOTH_PAIR
        flipped = ' with the sign flipped' if slope.value > 0.0 else ''
        values |= {'ring': str(pair[0]), 'satellite': str(pair[1]), 'flipped': flipped}
    return Finding(cause, values=values, explains=True)


def _as_fraction(found: Estimate) -> str:
    """Write a ratio as a fraction of small numbers, unless one is near by chance or none is."""
    ratio = Fraction(found.value).limit_denominator(_MAX_DENOMINATOR)
    by_chance = ratio.denominator**2 * found.expanded > _CHANCE
    return _written(found) if by_chance or not _is_near(found, float(ratio)) else str(ratio)


def _tooth_pair(mechanism: Mechanism, slope: float, uncertainty: float) -> tuple[int, int] | None:
    """Find the tooth numbers (zk, zs) nearest to the assumed ones that turn the output so."""
    least, greatest = (Fraction(slope) + sign * Fraction(uncertainty) for sign in (-1, 1))
    if least <= 0:
        return None
    zk, zs = mechanism.ring_teeth, mechanism.satellite_teeth
    return min(
        tooth_pairs(-1 / least, -1 / greatest, max(_MAX_TEETH, 2 * zk)),
        key=lambda pair: abs(pair[0] - zk) + abs(pair[1] - zs),
        default=None,
    )


class FactorFit:
    """The constant factor between recorded and expected values of a field, from running sums."""

    def __init__(self) -> None:
        self._sums = np.zeros(3)  # of expected², expected · recorded, recorded²

    def update(self, recorded: Array, expected: Array) -> None:
        """Add values (n,); those that are not finite are left out."""
        usable = np.isfinite(expected) & np.isfinite(recorded)
        x, y = expected[usable], recorded[usable]
        with np.errstate(over='ignore'):
            self._sums += (product(x, x), product(x, y), product(y, y))

    def factor(self) -> float | None:
        """Return recorded / expected; None if it is 1, or not constant, or for garbage."""
        with np.errstate(all='ignore'):
            xx, xy, yy = self._sums
            factor = float(xy / xx)
            scatter = float(yy - factor * xy)
        constant = math.isfinite(factor + scatter) and scatter <= _MAX_SCATTER**2 * yy
        return factor if constant and abs(factor - 1.0) > _MAX_SCATTER else None

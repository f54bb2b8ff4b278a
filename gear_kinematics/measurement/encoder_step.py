# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The step of an encoder, found in its readings.

Differences of readings are multiples of the step. They are also multiples of the resolution in
which they are recorded, as decimals or in single precision; a step is at least twice as coarse.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics.rotor_turns import TURN

Array = NDArray[np.float64]

UNITS = {'rad': 1.0, 'mrad': 1e-3, 'deg': math.radians(1.0), 'rev': TURN}
"""Units of angle in which readings may have been recorded, rad."""
_DIGITS = 12  # most decimals that are recognised
_USUAL = 0.95  # share of levels that are not stray
_ROUNDING = 8.0  # error of a reading after a few conversions of its unit, in its spacing
_LEAST = 4  # least number of levels: with fewer, any step fits
_COARSER = 1.9
"""Least ratio of a step to the resolution of the recording: 2, less rounding."""
_FITS = 0.15
"""Greatest root mean square distance from multiples of a step, in steps. It is 0.29 if there is no
step, and 0.15 if the readings are rounded to half a step."""
_MAX_STEPS = 100.0  # steps between levels that are counted without error
_CHANCE = 1e-3  # greatest probability that readings without a step fit one
_EXACT, _BETTER = 1e-3, 0.3
"""Distance, in steps, below which no finer step is tried; share of the distance so far that a
finer step must reach. By chance, half a step fits twice as badly."""
_STEADY = 0.9
"""Share of changes equal to the previous one from which on levels are those of an even motion, not
of an encoder."""


@dataclass(frozen=True, slots=True)
class Step:
    """The step between the readings of an encoder."""

    size: float  # in the unit of the readings; 0 if unknown
    seen: bool  # whether it shows in the readings; otherwise given, or that of the recording

    def scaled(self, factor: float) -> 'Step':
        """Return the step of readings multiplied by a factor."""
        return Step(self.size * abs(factor), self.seen)

    def joined(self, other: 'Step') -> 'Step':
        """Return the step of a difference of readings, whose variance is the sum of both."""
        return Step(math.hypot(self.size, other.size), self.seen and other.seen)


def step_of(counts: int | None, readings: Array) -> Step:
    """Return the step of an encoder, rad, from its counts per turn or its readings."""
    return Step(TURN / counts, seen=False) if counts else find_step(readings)


def find_step(readings: Array) -> Step:
    """Find the step of an encoder.

    Args:
        readings: (n,), rad, in the order of time.
    """
    levels = np.unique(readings)
    if len(levels) < _LEAST:
        return Step(0.0, seen=False)
    recorded = _recording_resolution(levels)
    # In an unknown unit, the resolution does not show: try all of them, from coarse to fine.
    finest = max(recorded, _ROUNDING * float(np.max(np.spacing(np.abs(levels)))))
    coarser = math.ceil(math.log2(max(1.0, np.ptp(levels) / finest)))
    best, nearest, tried = 0.0, _FITS / _BETTER, {0.0}
    for resolution in finest * 2.0 ** np.arange(coarser, -1, -1):
        divisor = common_divisor(levels, resolution)
        if divisor in tried:
            continue
        tried.add(divisor)
        step, distance = _fitted(levels, readings, divisor)
        # Any finer step fits as well; it must fit better.
        if distance < _BETTER * nearest:
            best, nearest = step, distance
        if nearest <= _EXACT:
            break
    return Step(best or recorded, best > 0.0)


def _recording_resolution(levels: Array) -> float:
    """Return the resolution of decimals or of single precision, if it shows; otherwise 0."""
    large = levels[_large(levels)]
    found = [0.0]
    for unit in UNITS.values():
        values = large / unit
        rounding = _ROUNDING * np.spacing(np.abs(values))
        single = values.astype(np.float32)
        if np.all(np.abs(values - single) <= rounding):
            found.append(unit * float(np.max(np.spacing(np.abs(single)))))
        for scale in 10.0 ** np.arange(_DIGITS + 1):
            scaled, error = (values - values[0]) * scale, rounding * scale  # without an offset
            if np.max(error) > 1.0 / _ROUNDING**2:
                break
            if np.all(np.abs(scaled - np.round(scaled)) <= error):
                found.append(unit / scale)
                break
    return float(max(found))


def common_divisor(levels: Array, resolution: float) -> float:
    """Return the greatest common divisor of the gaps, by Euclid's algorithm; 0 if none."""
    between = np.diff(levels)
    gaps, step = between[between > 0.5 * resolution], 0.0
    while len(gaps):
        # Equal gaps can differ by the resolution, by rounding.
        step = float(np.mean(gaps[gaps <= np.min(gaps) + 1.01 * resolution]))
        if step < _COARSER * resolution:
            return 0.0
        wholes = np.round(gaps / step)
        rest = np.abs(gaps - wholes * step)
        gaps = rest[rest > resolution * (1.0 + wholes)]
    near = between[(between > 0.5 * step) & (between < _MAX_STEPS * step)]
    return float(np.sum(near) / np.sum(np.round(near / step))) if len(near) else 0.0


def _fitted(levels: Array, readings: Array, step: float) -> tuple[float, float]:
    """Fit a step by least squares; return it and the rms distance of levels from its multiples.

    The distance is in steps; infinite if the levels are not those of an encoder.
    """
    none = 0.0, math.inf
    numbers = np.cumsum(np.round(np.diff(levels, prepend=levels[0]) / step))
    step, zero = np.polyfit(numbers, levels, 1).tolist()
    distance = float(np.std(levels - zero - step * numbers)) / step
    free = len(np.unique(numbers)) - 3  # the zero, the step, and the choice of it
    if distance > _FITS or (math.sqrt(12.0) * distance) ** free > _CHANCE:
        return none
    large = levels[_large(levels)] / (2.0 * step)
    changes = np.diff(np.round((readings - zero) / step))
    moving = changes[1:] != 0.0
    even = moving.any() and np.mean(changes[1:][moving] == changes[:-1][moving]) >= _STEADY
    return none if even or np.std(large - np.round(large)) < _FITS else (step, distance)


def _large(levels: Array) -> NDArray[np.bool_]:
    """Find the greatest levels, whose floating-point numbers are the farthest apart.

    A single corrupt reading, which may be far greater, must not be the only one.
    """
    sizes = np.abs(levels)
    large: NDArray[np.bool_] = 2.0 * sizes > np.quantile(sizes, _USUAL)
    return large

"""Uncertainties from blocks of successive samples, as noise is coloured."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from gear_kinematics.calibration.normal import Array
from gear_kinematics.state.uncertainty import Estimate, student_t

_TOGETHER = (1, 2, 4)
"""Numbers of successive blocks that are taken as one, in case neighbours are correlated."""
_FEWEST = 3
"""Groups of blocks from which a standard error is estimated."""


class StandardError(NamedTuple):
    """Of the mean of blocks."""

    value: float
    degrees_of_freedom: int


def standard_error(values: Array) -> StandardError:
    """Standard error of the mean of blocks in the order of time; 0 of fewer than three.

    It is the greatest of those from single blocks and from groups of neighbours.
    """
    errors = [StandardError(0.0, 1)]
    for size in _TOGETHER:
        groups = np.array_split(values, len(values) // size) if len(values) >= size else []
        if (count := len(groups)) >= _FEWEST:
            means = [float(group.mean()) for group in groups]
            value = float(np.std(means, ddof=1)) / math.sqrt(count)
            errors.append(StandardError(value, count - 1))
    return max(errors)


def is_as_good(errors: Array, best: Array) -> bool:
    """Whether errors of blocks are no greater than others by more than a standard error."""
    difference = errors - best
    return bool(difference.mean() <= standard_error(difference).value)


def widening(errors: Array, means: Sequence[Array]) -> float:
    """Factor by which an interval has to be wider because its width is an estimate itself.

    Student's t for the degrees of freedom with which the blocks' mean squares determine their
    mean, over that for infinitely many. Drift over a whole recording is correlated among all of
    its blocks. It consists of few cosine waves, and each has a single degree of freedom (F. E.
    Satterthwaite, Biometrics Bulletin 2 (1946) 110).

    Args:
        errors: mean squares of the errors of blocks, about as long each.
        means: of each recording, the mean errors of its blocks, in the order of time.
    """
    total = float(errors.sum())
    waves = np.concatenate([_wave_powers(values) for values in means])
    variance = (standard_error(errors).value / float(errors.mean())) ** 2
    variance += 2.0 * float(np.sum(np.square(waves / total)))
    degrees = 2.0 / variance if variance else math.inf
    return student_t(max(1, int(min(degrees, 1e9)))) / student_t(10**9)


def _wave_powers(values: Array) -> Array:
    """Sum of squares of each cosine wave of which values consist, without their mean."""
    spectrum = np.fft.rfft(np.concatenate([values, values[::-1]]))
    powers: Array = np.square(np.abs(spectrum[1:])) / (2.0 * len(values))
    return powers


def jackknife(value: float, repeats: Sequence[float]) -> Estimate:
    """Estimate a quantity from its values without each of the folds.

    Its uncertainty is that of the mean of the folds' pseudo-values.
    """
    count = len(repeats)
    pseudo_values = count * value - (count - 1) * np.array(repeats)
    return Estimate(value, *standard_error(pseudo_values), count)

# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Assessment of how well a calibration fits a measured transmission error."""

import math
from typing import NamedTuple, Self

import numpy as np

from gear_kinematics.wire.batches import Array

_SHARE = 0.05  # of samples that may be outside a 95 % interval
_TOLERATED = 0.07  # since the width of an interval is known to a few percent (docs/calibration.md)
# Standard deviations that chance exceeds with a probability of 1 % in a single judgement, and of
# 0.1 % in one of many successive judgements, as in the node.
_UNLIKELY_ONCE, _UNLIKELY = 2.326, 3.090


class CalibrationFit(NamedTuple):
    """Comparison of the measured transmission error with the calibration."""

    samples: int
    explained: float | None  # share of the error's variance that it explains; None if constant
    outside: float  # share of samples outside the 95 % interval, without the encoder's zero
    fits: bool  # whether `outside` is tolerable or explained by chance
    independent: float  # number of independent samples on which `outside` is based

    @property
    def outside_uncertainty(self) -> float:
        """Expanded uncertainty (95 %) of the long-run share outside the interval."""
        # Agresti and Coull's estimate, which is not 0 if no sample is outside.
        share = (self.outside * self.independent + 2.0) / (self.independent + 4.0)
        return 2.0 * math.sqrt(share * (1.0 - share) / (self.independent + 4.0))

    @classmethod
    def of(cls, error: Array, residual: Array, half_width: Array, *, once: bool = False) -> Self:
        """Judge samples, (n,) each, rad, after subtracting their mean, the encoder's zero.

        Args:
            error: measured minus ideal output angle.
            residual: measured minus corrected output angle.
            half_width: half width of the interval.
            once: whether this is a single judgement, not one of many.
        """
        error, residual = (column - column[0] for column in (error, residual))  # rounds less
        error, residual = error - error.mean(), residual - residual.mean()
        variance = float(error @ error)
        explained = 1.0 - float(residual @ residual) / variance if variance else None
        is_outside = np.abs(residual) > half_width
        outside = float(np.mean(is_outside))
        independent = independent_samples(is_outside - outside)
        # The arc sine of the root of a binomial share is about normal, with the variance 1/(4 n)
        # (M. S. Bartlett, Journal of the Royal Statistical Society, Supplement 3 (1936) 68).
        excess = math.asin(math.sqrt(outside)) - math.asin(math.sqrt(_SHARE))
        deviations = 2.0 * math.sqrt(independent) * excess
        by_chance = deviations <= (_UNLIKELY_ONCE if once else _UNLIKELY)
        fits = outside <= _TOLERATED or by_chance
        return cls(len(error), explained, outside, fits, independent)


def independent_samples(residual: Array) -> float:
    """Return how many independent samples are worth as much as a series, (n,), of mean 0.

    That is n/τ, at least 1, with the autocorrelation time τ from the initial positive
    autocorrelations (Geyer).
    """
    count = len(residual)
    size = 1 << (2 * count - 1).bit_length()
    spectrum = np.fft.rfft(residual, size)
    correlation = np.fft.irfft(spectrum * spectrum.conj(), size)[:count]
    if not correlation[0] > 0.0:
        return float(count)
    correlation /= correlation[0]
    ends = np.flatnonzero(correlation <= 0.0)
    positive = correlation[1 : ends[0] if len(ends) else count]
    return max(1.0, count / (1.0 + 2.0 * float(positive.sum())))

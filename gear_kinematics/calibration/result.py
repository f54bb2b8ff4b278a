"""What the calibration of a gear consists of."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from gear_kinematics.calibration.model import Samples
from gear_kinematics.calibration.normal import Array
from gear_kinematics.calibration.spectrum import Spectrum
from gear_kinematics.calibration.terms import Term
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.lost_motion.dynamic.ratio import RatioEstimate
from gear_kinematics.state.uncertainty import Estimate

_CERTAIN = 2.0
"""Expanded uncertainties from which on a delay is no coincidence; less is more likely none."""


@dataclass(frozen=True, eq=False, slots=True)
class Fitted:
    """A term of the calibration with its coefficients, in the units of the term's columns."""

    term: Term
    coefficients: Array
    amplitude: Estimate
    """rad; of a stop operator and of the wind-up with its sign."""


@dataclass(frozen=True, eq=False, slots=True)
class Residuals:
    """The error of one recording less its zero, (n,) each, at the samples that are used."""

    samples: Samples
    before: Array
    """rad, without the correction."""
    after: Array
    """rad, with the correction that was fitted without the sample's block."""
    zero: float
    """rad: what the encoder's zero adds."""
    delay: Estimate | None = None
    """s: by how much the output's stamps are later than its angles; None if not separable."""

    @property
    def delayed(self) -> bool:
        """Whether a delay was taken out."""
        return is_certain(self.delay)

    @property
    def delay_half_width(self) -> float:
        """What the uncertainty of a delay that was taken out adds to the interval, rad."""
        if self.delay is None or not self.delayed:
            return 0.0
        return (self.delay.uncertainty or 0.0) * math.sqrt(np.mean(np.square(self.samples.speed)))


def is_certain(delay: Estimate | None) -> bool:
    """Whether a delay is large enough to be taken out."""
    return delay is not None and abs(delay.value) > _CERTAIN * (delay.uncertainty or 0.0)


@dataclass(frozen=True, eq=False, slots=True)
class Fit:
    """The result."""

    ratio: Fraction
    mechanism: Mechanism | None
    terms: tuple[Fitted, ...]
    covariance: Array
    """Of all coefficients of the terms."""
    constant: float
    """rad: makes the mean deviation zero."""
    half_width: float
    """rad, of the interval that contains 95 % of the samples left out."""
    outside_half_width: float
    """rad, the same for conditions that were not calibrated."""
    coverage: float
    """Share of samples within the interval from the other folds."""
    rms_before: float
    """rad."""
    rms_after: float
    """rad, of samples left out."""
    helps: bool
    """Whether the correction reduces the error by more than a standard error."""
    recordings: tuple[Residuals, ...]
    spectra: tuple[Spectrum | None, Spectrum | None]
    """Before and after."""
    refused: Mapping[str, str]
    """Terms that the recordings cannot determine, with the cause."""
    fitted_ratio: RatioEstimate | None = None
    """The ratio, if it was fitted."""

"""What the calibration of a gear consists of."""

from collections.abc import Mapping
from fractions import Fraction
from typing import NamedTuple

from gear_kinematics.kinematics import Mechanism
from gear_kinematics.measurement.calibration.samples import Samples
from gear_kinematics.measurement.calibration.spectrum import Spectrum
from gear_kinematics.measurement.calibration.terms import Term
from gear_kinematics.measurement.ratio import RatioEstimate
from gear_kinematics.measurement.recording import Array
from gear_kinematics.state.uncertainty import Estimate


class FittedTerm(NamedTuple):
    """A term of the calibration."""

    term: Term
    coefficients: Array
    """In the units of the calibration file."""
    amplitude: Estimate
    """rad; of a stop operator and of the wind-up with its sign."""


class FittedRecording(NamedTuple):
    """The error of one recording less its zero and delay, (n,) each, of the used samples."""

    samples: Samples
    before: Array
    """rad, without the correction."""
    after: Array
    """rad, with the correction that was fitted without the half that holds the sample."""
    zero: float
    """rad: what the encoder's zero adds."""
    delay: Estimate | None
    """s: by how much the output's angles are late; taken out if clear; None if not separable."""


class Fit(NamedTuple):
    """The result."""

    ratio: Fraction
    mechanism: Mechanism | None
    terms: tuple[FittedTerm, ...]
    covariance: Array
    """Of all coefficients of the terms."""
    constant: float
    """rad: makes the mean deviation zero."""
    half_width: float
    """rad, of the interval that contains 95 % of the samples left out."""
    outside_half_width: float
    """rad, the same for conditions that were not calibrated."""
    coverage: float
    """Share of samples within the interval from the other half."""
    rms_before: float
    """rad."""
    rms_after: float
    """rad, of samples left out."""
    helps: bool
    """Whether the correction reduces the error by more than a standard error."""
    recordings: tuple[FittedRecording, ...]
    spectra: tuple[Spectrum | None, ...]
    """Before and after."""
    refused: Mapping[str, str]
    """Terms that the recordings cannot determine, with the cause."""
    fitted_ratio: RatioEstimate | None
    """The ratio, if it was fitted."""
